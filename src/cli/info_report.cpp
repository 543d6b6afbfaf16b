#include "cli/info_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "scene/filters.h"
#include "scene/kind_names.h"
#include "util/printable.h"

namespace alhazen::impl {

namespace {

constexpr size_t lines_shown = 20;

std::string name_of(FilterType type) {
  for (const auto& [name, filter] : named_filters())
    if (filter.type == type) return name;
  return {};
}

/// "12,345".
std::string grouped(uint64_t number) {
  std::string text = std::to_string(number);
  for (size_t i = text.size(); i > 3; i -= 3) text.insert(i - 3, ",");
  return text;
}

std::string counted(uint64_t number, const std::string& what) {
  return grouped(number) + " " + what + (number == 1 ? "" : "s");
}

/// Of spheres, cylinders and disks.
std::string counted_primitives(uint64_t number) {
  return grouped(number) + (number == 1 ? " sphere, cylinder or disk" : " spheres, cylinders and disks");
}

/// "12.3 MB", by powers of 1000.
std::string size_text(uint64_t bytes) {
  const double value = static_cast<double>(bytes);
  if (bytes >= 1'000'000'000) return fmt::format("{:.2f} GB", value * 1e-9);
  if (bytes >= 1'000'000) return fmt::format("{:.1f} MB", value * 1e-6);
  return bytes >= 1000 ? fmt::format("{:.1f} kB", value * 1e-3) : fmt::format("{} bytes", bytes);
}

std::string point_text(const Vec3d& p) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", p.x, p.y, p.z); }

Vec3d camera_position(const Scene& scene) { return scene.camera.world_from_camera.start.point(Vec3d{0, 0, 0}); }

Vec3d camera_direction(const Scene& scene) {
  const Vec3d ahead = scene.camera.world_from_camera.start.point(Vec3d{0, 0, 1});
  const Vec3d direction = ahead - camera_position(scene);
  const double size = length(direction);
  return size > 0 ? direction / size : direction;
}

/// A heading with the lines below it.
void add_list(std::string& text, const std::string& heading, const std::vector<std::string>& lines, bool all) {
  text += heading + "\n";
  const size_t shown = all ? lines.size() : std::min(lines.size(), lines_shown);
  for (size_t i = 0; i < shown; ++i) text += "  " + printable(lines[i]) + "\n";
  if (shown < lines.size()) text += "  and " + grouped(lines.size() - shown) + " more: --all lists them\n";
}

std::string camera_text(const SceneReport& r) {
  const Camera& camera = r.scene.camera;
  std::string text = camera_name(camera.kind);
  if (camera.kind == CameraKind::perspective) text += fmt::format(", field of view {:.4g} degrees", camera.fov);
  text += ", at " + point_text(camera_position(r.scene)) + ", looking along " + point_text(camera_direction(r.scene));
  if (camera.lens_radius > 0)
    text += fmt::format(", lens radius {:.4g} focused at {:.4g}", camera.lens_radius, camera.focal_distance);
  return text;
}

std::string film_text(const SceneReport& r) {
  const RenderSettings& s = r.settings;
  return fmt::format("{} x {} pixels{}, {}{} samples each, {} bounces, {}, sampler {}, filter {}", s.width, s.height,
                     s.window.width() == s.width && s.window.height() == s.height
                         ? ""
                         : fmt::format(" ({} x {} of them rendered)", s.window.width(), s.window.height()),
                     s.asked.noise > 0 ? "at most " : "", s.samples_per_pixel, s.max_segments - 1,
                     to_string(s.integrator), to_string(s.sampler), name_of(r.scene.filter.type));
}

std::string geometry_text(const SceneDescription& d) {
  std::string text = counted(d.triangles, "triangle");
  if (d.triangles != d.stored_triangles) text += " (" + grouped(d.stored_triangles) + " stored)";
  if (d.primitives > 0) text += ", " + counted_primitives(d.primitives);
  if (d.instances > 0) text += ", " + counted(d.instances, "instance");
  return text + ", meshes of " + size_text(d.mesh_bytes);
}

std::vector<std::string> object_lines(const SceneDescription& d) {
  std::vector<std::string> lines;
  for (const ObjectDescription& o : d.objects) {
    std::string size = o.triangles > 0 ? counted(o.triangles, "triangle") : "";
    if (o.primitives > 0 && (o.primitives > 1 || o.triangles > 0))
      size += (size.empty() ? "" : ", ") + counted_primitives(o.primitives);
    if (o.instances != 1) size += (size.empty() ? "" : ", ") + counted(o.instances, "instance");
    lines.push_back(o.name + (size.empty() ? "" : ": " + size) + (o.material.empty() ? "" : ", " + o.material));
  }
  return lines;
}

std::vector<std::string> light_lines(const SceneDescription& d) {
  std::vector<std::string> lines;
  for (const LightDescription& light : d.lights)
    lines.push_back(light.name + ": " + light.kind + ", " + light.where.to_string() + ", " +
                    point_text(light.radiance) +
                    (light.triangles > 0 ? ", " + counted(light.triangles, "triangle") : ""));
  return lines;
}

std::vector<std::string> material_lines(const SceneDescription& d) {
  std::vector<std::string> lines;
  for (const MaterialDescription& material : d.materials)
    lines.push_back((material.name == material.kind ? material.kind : material.name + ": " + material.kind) + ", " +
                    counted(material.shapes, "shape"));
  return lines;
}

std::vector<std::string> image_lines(const SceneDescription& d) {
  std::vector<std::string> lines;
  for (const ImageDescription& image : d.images)
    lines.push_back(fmt::format("{}: {} x {}, {} x {} bits, {}{}", image.name, image.width, image.height,
                                image.channels, image.bits, size_text(image.bytes),
                                image.use == "texture" ? "" : ", " + image.use));
  return lines;
}

nlohmann::ordered_json vector_json(const Vec3d& v) { return nlohmann::ordered_json::array({v.x, v.y, v.z}); }

nlohmann::ordered_json objects_json(const SceneDescription& d) {
  auto list = nlohmann::ordered_json::array();
  for (const ObjectDescription& o : d.objects)
    list.push_back({{"name", o.name},
                    {"triangles", o.triangles},
                    {"primitives", o.primitives},
                    {"instances", o.instances},
                    {"bytes", o.bytes},
                    {"material", o.material}});
  return list;
}

nlohmann::ordered_json images_json(const SceneDescription& d) {
  auto list = nlohmann::ordered_json::array();
  for (const ImageDescription& i : d.images)
    list.push_back({{"name", i.name},
                    {"use", i.use},
                    {"width", i.width},
                    {"height", i.height},
                    {"channels", i.channels},
                    {"bits", i.bits},
                    {"bytes", i.bytes}});
  return list;
}

}  // namespace

std::string report_text(const SceneReport& r, bool all) {
  const SceneDescription& d = r.contents;
  std::string text;
  const auto line = [&](const char* name, const std::string& value) {
    text += fmt::format("{:<10} {}\n", name, printable(value));
  };
  line("scene", r.file);
  if (!d.bounds.is_empty()) {
    const Vec3d size = d.bounds.diagonal();
    line("bounds", fmt::format("{} to {}, {:.4g} x {:.4g} x {:.4g} scene units", point_text(d.bounds.low),
                               point_text(d.bounds.high), size.x, size.y, size.z));
  }
  line("camera", camera_text(r));
  line("film", film_text(r));
  if (!r.settings.asked.quality.empty()) line("quality", r.settings.asked.quality);
  line("geometry", geometry_text(d));
  const auto names = [&](const char* kind, const std::vector<std::string>& choices) {
    if (choices.empty()) return;
    std::vector<std::string> lines;
    for (size_t i = 0; i < choices.size(); ++i) lines.push_back(std::to_string(i) + " " + choices[i]);
    add_list(text, fmt::format("{}: {}", kind, choices.size()), lines, all);
  };
  if (r.choices.cameras.size() > 1) names("cameras", r.choices.cameras);
  names("variants", r.choices.variants);
  names("animations", r.choices.animations);
  add_list(text, fmt::format("lights: {}", d.lights.size()), light_lines(d), all);
  add_list(text, fmt::format("materials: {}", d.materials.size()), material_lines(d), all);
  add_list(text, fmt::format("objects: {}", d.objects.size()), object_lines(d), all);
  add_list(text, fmt::format("images: {}, {}", d.images.size(), size_text(d.image_bytes)), image_lines(d), all);
  text += fmt::format("not supported, or replaced: {}{}\n", r.warnings.size(),
                      r.warnings.empty() ? "" : ", see the warnings");
  return text;
}

std::string report_json(const SceneReport& r) {
  const SceneDescription& d = r.contents;
  using Json = nlohmann::ordered_json;
  auto lights = Json::array(), materials = Json::array(), warnings = Json::array();
  for (const LightDescription& light : d.lights)
    lights.push_back({{"name", light.name},
                      {"kind", light.kind},
                      {"radiance", vector_json(light.radiance)},
                      {"triangles", light.triangles}});
  for (const MaterialDescription& material : d.materials)
    materials.push_back({{"name", material.name}, {"kind", material.kind}, {"shapes", material.shapes}});
  for (const Diagnostics::Warning& warning : r.warnings) warnings.push_back(warning.to_string());
  const RenderSettings& s = r.settings;
  const Json j{
      {"scene", r.file},
      {"bounds",
       d.bounds.is_empty() ? Json() : Json{{"min", vector_json(d.bounds.low)}, {"max", vector_json(d.bounds.high)}}},
      {"camera",
       {{"kind", camera_name(r.scene.camera.kind)},
        {"fov", r.scene.camera.fov},
        {"position", vector_json(camera_position(r.scene))},
        {"direction", vector_json(camera_direction(r.scene))}}},
      {"cameras",
       r.choices.cameras.empty() ? std::vector<std::string>{camera_name(r.scene.camera.kind)} : r.choices.cameras},
      {"variants", r.choices.variants},
      {"animations", r.choices.animations},
      {"width", s.window.width()},
      {"height", s.window.height()},
      {"quality", s.asked.quality.empty() ? "none" : s.asked.quality},
      {"spp", s.samples_per_pixel},
      {"max_depth", s.max_segments - 1},
      {"integrator", to_string(s.integrator)},
      {"sampler", to_string(s.sampler)},
      {"filter", name_of(r.scene.filter.type)},
      {"triangles", d.triangles},
      {"stored_triangles", d.stored_triangles},
      {"primitives", d.primitives},
      {"instances", d.instances},
      {"meshes", r.scene.meshes.size()},
      {"mesh_bytes", d.mesh_bytes},
      {"textures", d.textures},
      {"image_bytes", d.image_bytes},
      {"lights", lights},
      {"materials", materials},
      {"objects", objects_json(d)},
      {"images", images_json(d)},
      {"warnings", warnings}};
  // Names are bytes of the file and need not be valid UTF-8.
  return j.dump(-1, ' ', true, Json::error_handler_t::replace) + "\n";
}

}  // namespace alhazen::impl

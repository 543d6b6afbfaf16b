#include "io/pbrt/build.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include "io/pbrt/materials.h"
#include "io/pbrt/options.h"
#include "io/pbrt/shapes.h"

namespace alhazen::pbrt {

namespace {

NamedEntry& reference(std::map<std::string, NamedEntry>& entries, const std::string& name, const Place& place,
                      const std::string& what) {
  NamedEntry& entry = entries[name];
  if (entry.defined || entry.undefined) return entry;
  // The error is made now, while the text of the file is at hand for its excerpt.
  entry.undefined.emplace(error_at(place, what));
  return entry;
}

void require_definitions(const std::map<std::string, NamedEntry>& entries) {
  for (const auto& [name, entry] : entries)
    if (!entry.defined && entry.undefined) throw *entry.undefined;
}

}  // namespace

Build::Build(std::string folder_, Diagnostics& diagnostics_) : diagnostics(diagnostics_), folder(std::move(folder_)) {}

void Build::warn_replaced(const ParameterList& list, const std::string& instead) {
  warn(list.place(), list.directive() + " is not supported; " + instead);
}

std::string Build::existing_file(const Place& place, const std::string& name) const {
  const std::filesystem::path path = std::filesystem::path(folder) / name;
  std::error_code error;
  if (name.empty() || name.find('\0') != std::string::npos || !std::filesystem::is_regular_file(path, error))
    fail(place, "there is no file \"" + name + "\" (looked for " + path.string() +
                    "); paths are relative to the folder of the scene file");
  return path.string();
}

uint32_t Build::constant_texture(const Vec3d& value) {
  const auto [entry, is_new] = constants.try_emplace({value.x, value.y, value.z}, 0u);
  if (is_new) {
    entry->second = static_cast<uint32_t>(scene.textures.size());
    scene.textures.emplace_back().value = value;
  }
  return entry->second;
}

NamedEntry& Build::named_material(const std::string& name, const Place& place) {
  NamedEntry& entry =
      reference(materials, name, place, "material \"" + name + "\" is not defined; define it with MakeNamedMaterial");
  if (entry.index == no_index) {
    entry.index = static_cast<uint32_t>(scene.materials.size());
    scene.materials.emplace_back().name = name;
    material_is_invisible.push_back(false);
  }
  return entry;
}

NamedEntry& Build::named_object(const std::string& name, const Place& place) {
  NamedEntry& entry = reference(objects, name, place,
                                "object \"" + name + "\" is not defined; define it with ObjectBegin ... ObjectEnd");
  if (entry.index == no_index) {
    entry.index = static_cast<uint32_t>(scene.groups.size());
    scene.groups.emplace_back().name = name;
  }
  return entry;
}

Scene Build::finish() {
  require_definitions(materials);
  require_definitions(objects);
  finish_materials(*this);
  bool any_shape = false, any_emission = !scene.lights.empty();
  for (ShapeGroup& group : scene.groups) {
    std::erase_if(group.shapes, [&](const Shape& shape) { return material_is_invisible[shape.material]; });
    any_shape = any_shape || !group.shapes.empty();
    for (const Shape& shape : group.shapes) any_emission = any_emission || shape.emission;
  }
  tessellate_spheres_of_skewed_instances(*this);
  const SourceLocation where{scene.name, 0, 0};
  if (!any_shape && scene.lights.empty())
    diagnostics.warn(where, "the scene has no shapes and no lights; the picture will be black");
  else if (!any_emission)
    diagnostics.warn(where, "the scene has no lights; the picture will be black");
  if (lens_image_distance) scene.camera.fov = realistic_fov(*this);
  const double shutter = scene.camera.shutter_close - scene.camera.shutter_open;
  scene.film.exposure = exposure_time.value_or(shutter) * iso / 100 * lens_exposure;
  return std::move(scene);
}

}  // namespace alhazen::pbrt

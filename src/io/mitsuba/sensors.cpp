#include "io/mitsuba/sensors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "io/mitsuba/attributes.h"
#include "scene/filters.h"
#include "scene/limits.h"
#include "util/quoted.h"

namespace alhazen::impl::mitsuba {

namespace {

constexpr int64_t max_side = 100'000, max_pixels = 1'000'000'000;

int64_t read_pixels(ObjectReader& reader, const char* name, int64_t fallback, int64_t least, int64_t most) {
  const int64_t value = reader.integer(name, fallback);
  if (value < least || value > most)
    fail(reader.place_of(name), quoted(std::string_view(name)) + " is " + std::to_string(value) + "; it must be from " +
                                    std::to_string(least) + " to " + std::to_string(most) + " pixels");
  return value;
}

void read_filter(Build& build, const Property& property) {
  ObjectReader reader(build.document, property.object);
  const std::string& type = reader.object().type;
  Filter& filter = build.scene.filter;
  if (type == "box") {
    filter.type = FilterType::box;
    filter.x_radius = reader.positive("radius", 0.5);
  } else if (type == "tent") {
    filter.type = FilterType::triangle;
    filter.x_radius = reader.positive("radius", 1);
  } else if (type == "gaussian") {
    filter.type = FilterType::gaussian;
    filter.sigma = reader.positive("stddev", 0.5);
    filter.x_radius = 4 * filter.sigma;
  } else if (type == "mitchell") {
    filter = {.type = FilterType::mitchell, .x_radius = 2, .y_radius = 2};
    filter.b = reader.number("B", reader.number("A", 1.0 / 3));
    filter.c = reader.number("C", 1.0 / 3);
  } else if (type == "catmullrom") {
    filter = {.type = FilterType::mitchell, .x_radius = 2, .y_radius = 2, .b = 0, .c = 0.5};
  } else if (type == "lanczos") {
    filter.type = FilterType::sinc;
    filter.x_radius = filter.tau = static_cast<double>(reader.integer("lobes", 3));
  } else {
    fail(reader.place(),
         "unknown rfilter " + quoted(type) + "; use box, tent, gaussian, mitchell, catmullrom or lanczos");
  }
  filter.y_radius = filter.x_radius;
  if (!(filter.x_radius > 0 && filter.x_radius <= max_filter_radius))
    fail(reader.place(), "the radius of the pixel filter must be over 0 and at most 64 pixels");
  reader.reject_unknown();
}

void read_film(Build& build, const Property& property) {
  ObjectReader reader(build.document, property.object);
  const std::string& type = reader.object().type;
  if (type == "specfilm")
    build.warn(reader.place(), "the film 'specfilm' is not supported; linear sRGB is written");
  else if (type != "hdrfilm" && type != "ldrfilm" && type != "mfilm")
    fail(reader.place(), "unknown film " + quoted(type) + "; use hdrfilm");
  FilmSettings& film = build.scene.film;
  film.width = read_pixels(reader, "width", 768, 1, max_side);
  film.height = read_pixels(reader, "height", 576, 1, max_side);
  if (film.width * film.height >= max_pixels)
    fail(reader.place_of("height"), "the image has 10^9 pixels or more; lower 'width' or 'height'");
  const int64_t x = read_pixels(reader, "crop_offset_x", 0, 0, film.width - 1);
  const int64_t y = read_pixels(reader, "crop_offset_y", 0, 0, film.height - 1);
  const int64_t width = read_pixels(reader, "crop_width", film.width - x, 1, film.width - x);
  const int64_t height = read_pixels(reader, "crop_height", film.height - y, 1, film.height - y);
  if (width != film.width || height != film.height) film.pixel_bounds = {x, x + width, y, y + height};
  build.scene.filter = {FilterType::gaussian, 2, 2, 0.5};
  const std::vector<const Property*> filters = reader.objects("rfilter");
  if (filters.size() > 1) fail(filters[1]->place, "a film has one rfilter; here is another");
  if (!filters.empty()) read_filter(build, *filters[0]);
  reader.ignore({"file_format", "pixel_format", "component_format", "sample_border", "compensate", "banner",
                 "attach_log", "high_quality_edges", "gamma", "exposure", "tonemap_method", "key", "burn"});
  if (type == "specfilm") reader.ignore_all();
  reader.reject_unknown();
}

/// Samples are those of the Sobol' sequence whatever the sampler is.
void read_sampler(Build& build, const Property& property) {
  ObjectReader reader(build.document, property.object);
  static const std::set<std::string_view> known{"independent", "stratified", "multijitter", "orthogonal",
                                                "ldsampler",   "halton",     "hammersley",  "sobol"};
  const std::string& type = reader.object().type;
  if (!known.contains(type)) fail(reader.place(), "unknown sampler " + quoted(type) + "; use independent");
  const int64_t count = reader.integer("sample_count", 4), seed = reader.integer("seed", 0);
  if (count < 1 || count > max_samples_per_pixel)
    fail(reader.place_of("sample_count"), "'sample_count' must be from 1 to " + std::to_string(max_samples_per_pixel));
  if (seed < 0 || seed > int64_t{0xffffffff}) fail(reader.place_of("seed"), "'seed' must be from 0 to 4294967295");
  build.scene.samples_per_pixel = count;
  build.scene.seed = static_cast<uint32_t>(seed);
  reader.ignore({"jitter", "strength", "dimension", "scramble"});
  reader.reject_unknown();
}

double focal_length(ObjectReader& reader) {
  std::string text = reader.text("focal_length", "50mm");
  if (text.ends_with("mm")) text.resize(text.size() - 2);
  const double millimetres = parse_finite(text, reader.place_of("focal_length"), "'focal_length'");
  if (!(millimetres > 0)) fail(reader.place_of("focal_length"), "'focal_length' must be over 0");
  return millimetres;
}

/// The tangent of half the horizontal field of view.
double half_width(ObjectReader& reader, double aspect) {
  if (!reader.has("fov")) {
    // That of film of 36 by 24 millimetres, along its diagonal.
    const double half = std::hypot(36.0, 24.0) / (2 * focal_length(reader));
    return half / std::sqrt(1 + 1 / (aspect * aspect));
  }
  if (reader.has("focal_length")) fail(reader.place_of("fov"), "give either 'fov' or 'focal_length'");
  const double fov = reader.number("fov", 0);
  if (!(fov > 0 && fov < 180)) fail(reader.place_of("fov"), "'fov' must be over 0 and under 180 degrees");
  const double half = std::tan(fov * std::numbers::pi / 360);
  std::string axis = reader.text("fov_axis", "x");
  if (axis == "smaller") axis = aspect > 1 ? "y" : "x";
  if (axis == "larger") axis = aspect > 1 ? "x" : "y";
  if (axis == "x") return half;
  if (axis == "y") return half * aspect;
  if (axis == "diagonal") return half / std::sqrt(1 + 1 / (aspect * aspect));
  fail(reader.place_of("fov_axis"), "unknown 'fov_axis' " + quoted(axis) + "; use x, y, diagonal, smaller or larger");
}

void read_perspective(ObjectReader& reader, double aspect, Camera& camera) {
  const double half = half_width(reader, aspect);
  // Over the shorter side, within which the screen window is [-1, 1].
  const double shorter = aspect > 1 ? half / aspect : half;
  camera.fov = 2 * std::atan(shorter) * 180 / std::numbers::pi;
  const double x = reader.number("principal_point_offset_x", 0), y = reader.number("principal_point_offset_y", 0);
  if (x == 0 && y == 0) return;
  const double wide = std::max(aspect, 1.0), high = std::max(1 / aspect, 1.0);
  camera.screen_window = {wide * (2 * x - 1), wide * (2 * x + 1), high * (-2 * y - 1), high * (-2 * y + 1)};
}

/// Across the image x is from -1 to 1 in the space of the camera.
void read_orthographic(double aspect, Camera& camera) {
  camera.kind = CameraKind::orthographic;
  camera.screen_window = {-1, 1, -1 / aspect, 1 / aspect};
}

void check_no_scale(const ObjectReader& reader, const Transform& world) {
  double scale = 1;
  if (!world.is_similarity(scale) || std::abs(scale - 1) > 1e-3)
    fail(reader.place_of("to_world"), "the transform of a perspective camera must not scale or shear");
}

}  // namespace

void set_sensor(Build& build, const Property& property) {
  ObjectReader reader(build.document, property.object);
  const std::string& type = reader.object().type;
  if (type != "perspective" && type != "thinlens" && type != "orthographic")
    fail(reader.place(),
         "sensors of type " + quoted(type) + " are not supported; use perspective, thinlens or orthographic");
  Scene& scene = build.scene;
  scene.film.width = 768;
  scene.film.height = 576;
  scene.samples_per_pixel = 4;
  scene.filter = {FilterType::gaussian, 2, 2, 0.5};
  for (const Property* film : reader.objects("film")) read_film(build, *film);
  for (const Property* sampler : reader.objects("sampler")) read_sampler(build, *sampler);
  const double aspect = static_cast<double>(scene.film.width) / static_cast<double>(scene.film.height);
  const Transform world = reader.transform("to_world");
  Camera camera;
  if (type == "orthographic") {
    read_orthographic(aspect, camera);
  } else {
    check_no_scale(reader, world);
    read_perspective(reader, aspect, camera);
  }
  const double far = reader.positive("far_clip", 1e4);
  camera.focal_distance = reader.positive("focus_distance", far);
  if (type == "thinlens") {
    if (!reader.has("aperture_radius")) fail(reader.place(), reader.name() + " needs its 'aperture_radius'");
    camera.lens_radius = reader.positive("aperture_radius", 1);
  }
  // x is to the left in the format.
  const Transform world_from_camera = world * Transform::scale({-1, 1, 1});
  camera.world_from_camera = {world_from_camera, world_from_camera};
  scene.camera = camera;
  // The axis nearest to upward in the image.
  const Vec3d up = world.direction({0, 1, 0});
  const int axis = std::abs(up.y) >= std::abs(up.x) && std::abs(up.y) >= std::abs(up.z) ? 1
                   : std::abs(up.z) >= std::abs(up.x)                                   ? 2
                                                                                        : 0;
  scene.up[axis] = up[axis] < 0 ? -1 : 1;
  reader.ignore({"near_clip", "shutter_open", "shutter_close"});
  for (const Property* medium : reader.objects("medium"))
    build.warn(medium->place, "participating media are not supported; they are omitted");
  reader.reject_unknown();
}

namespace {

/// Integrators that simulate less or more than `path`, and what is said of it.
const std::map<std::string, const char*> replaced_integrators{
    {"volpath", "participating media are omitted"},
    {"volpathmis", "participating media are omitted"},
    {"ptracer", "the image is the same, up to noise and to caustics of delta lights"},
    {"prb", "the image is the same"},
    {"prbvolpath", "participating media are omitted"},
    {"prb_basic", "the image is the same"},
    {"bdpt", "the image is the same, up to noise and to caustics of delta lights"},
    {"depth", "it computes another quantity"},
    {"stokes", "polarization is omitted"}};

}  // namespace

void set_integrator(Build& build, const Property& property) {
  ObjectReader reader(build.document, property.object);
  const std::string& type = reader.object().type;
  if (type == "moment" || type == "aov" || type == "stokes") {
    const std::vector<const Property*> nested = reader.objects("integrator");
    if (type == "aov")
      build.warn(reader.place(), "the layers of the integrator 'aov' are not written; --aov asks for layers");
    for (const Property* each : nested) set_integrator(build, *each);
    if (!nested.empty()) reader.ignore_all();
    if (!nested.empty() || type == "aov") return;
  }
  if (const auto replaced = replaced_integrators.find(type); replaced != replaced_integrators.end()) {
    build.warn(reader.place(),
               "the integrator " + quoted(type) + " is not supported; 'path' is used: " + replaced->second);
    build.scene.replaced_integrator = type;
  } else if (type != "path" && type != "direct") {
    fail(reader.place(), "unknown integrator " + quoted(type) + "; use path or direct");
  }
  // Depths count segments: with 1 only emitters are seen.
  const int64_t depth = type == "direct" ? 2 : reader.integer("max_depth", -1);
  if (depth < -1 || depth == 0) fail(reader.place_of("max_depth"), "'max_depth' must be 1 or more, or -1 for no limit");
  build.scene.max_depth = depth == -1 ? max_bounces : std::min(depth - 1, max_bounces);
  if (reader.boolean("hide_emitters", false))
    build.warn(reader.place_of("hide_emitters"), "'hide_emitters' is not supported; emitters are seen");
  reader.ignore({"rr_depth", "timeout", "block_size", "samples_per_pass", "shading_samples", "emitter_samples",
                 "bsdf_samples", "strict_normals"});
  if (!build.scene.replaced_integrator.empty()) reader.ignore_all();
  reader.reject_unknown();
}

}  // namespace alhazen::impl::mitsuba

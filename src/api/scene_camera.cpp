// The camera, the film and the defaults of a public scene.

#include <algorithm>
#include <array>
#include <cmath>

#include "alhazen/scene.h"
#include "api/parts.h"
#include "pipeline/choose_view.h"
#include "render/quality.h"
#include "scene/filters.h"
#include "scene/limits.h"

namespace ALHAZEN_NAMESPACE {

namespace {

constexpr uint32_t camera_kinds = 4, filter_kinds = 5;
constexpr int64_t max_side = 100'000, max_pixels = 1'000'000'000;

Camera public_camera(const impl::Camera& camera) {
  return {.kind = static_cast<CameraKind>(camera.kind),
          .transform = impl::public_transform(camera.world_from_camera),
          .fov = camera.fov,
          .screen_window = camera.screen_window,
          .frame_aspect_ratio = camera.frame_aspect_ratio,
          .lens_radius = camera.lens_radius,
          .focal_distance = camera.focal_distance,
          .shutter_open = camera.shutter_open,
          .shutter_close = camera.shutter_close};
}

impl::Camera described_camera(const Camera& given) {
  impl::Camera camera;
  camera.kind = impl::same_kind<impl::CameraKind>("kind", given.kind, camera_kinds);
  camera.world_from_camera = impl::moving_transform("transform", given.transform);
  if (!(given.fov > 0 && given.fov < 180)) impl::refuse_argument("fov", "must be over 0 and under 180 degrees");
  camera.fov = given.fov;
  if (given.screen_window) {
    for (const double edge : *given.screen_window) impl::finite_number("screen_window", edge);
    const auto& [x0, x1, y0, y1] = *given.screen_window;
    if (x0 == x1 || y0 == y1) impl::refuse_argument("screen_window", "has no area");
    camera.screen_window = given.screen_window;
  }
  if (given.frame_aspect_ratio)
    camera.frame_aspect_ratio = impl::positive_number("frame_aspect_ratio", *given.frame_aspect_ratio);
  camera.lens_radius = impl::non_negative_number("lens_radius", given.lens_radius);
  camera.focal_distance = impl::positive_number("focal_distance", given.focal_distance);
  camera.shutter_open = impl::finite_number("shutter_open", given.shutter_open);
  camera.shutter_close = impl::finite_number("shutter_close", given.shutter_close);
  if (!(camera.shutter_open < camera.shutter_close))
    impl::refuse_argument("shutter_close", "must be later than 'shutter_open'");
  return camera;
}

/// Places the camera as settings of a render do.
void place_camera(impl::SceneState& s, const Settings& settings) {
  const impl::Camera before = s.description.camera;
  try {
    impl::Camera camera = before.is_default ? impl::default_camera(s.description, 0) : before;
    camera = impl::placed_camera(settings, camera, s.description);
    camera.is_default = false;
    s.description.camera = camera;
  } catch (...) {
    s.description.camera = before;
    throw;
  }
  ++s.revisions.camera;
}

/// Seeing the whole scene is possible with a perspective camera alone.
void check_can_fit(const impl::SceneState& s, const char* function) {
  const impl::Camera& camera = s.description.camera;
  if (camera.kind != impl::CameraKind::perspective || camera.screen_window || camera.frame_aspect_ratio)
    throw InputError(
        std::string(function) +
        " needs a perspective camera without a screen window or frame aspect ratio to see the whole scene");
}

constexpr std::array integrators{impl::IntegratorKind::path, impl::IntegratorKind::iterative,
                                 impl::IntegratorKind::recursive, impl::IntegratorKind::branching};
constexpr std::array samplers{impl::SamplerType::sobol, impl::SamplerType::zsobol, impl::SamplerType::independent};

template <class Public, class Table>
Public position_in(const Table& table, typename Table::value_type value) {
  return static_cast<Public>(std::find(table.begin(), table.end(), value) - table.begin());
}

}  // namespace

Camera Scene::camera() const {
  const impl::Scene& scene = state().description;
  return public_camera(scene.camera.is_default ? impl::default_camera(scene, 0) : scene.camera);
}

void Scene::set_camera(const Camera& camera) {
  state().description.camera = described_camera(camera);
  ++state().revisions.camera;
}

void Scene::look_at(const Vec3& eye, const Vec3& target, const std::optional<Vec3>& up) {
  impl::finite_vector("eye", eye);
  impl::finite_vector("target", target);
  if (eye == target) impl::refuse_argument("target", "must be another point than 'eye'");
  if (up) Transform::look_at(eye, target, *up);  // for its errors
  Settings settings;
  settings.look_at = {eye.x, eye.y, eye.z, target.x, target.y, target.z};
  if (up) settings.look_at.insert(settings.look_at.end(), {up->x, up->y, up->z});
  try {
    place_camera(state(), settings);
  } catch (const InputError&) {
    impl::refuse_argument("up", "must be given where the direction of view is that of the scene's axis upwards");
  }
}

void Scene::orbit(double azimuth, double elevation, std::optional<double> distance) {
  impl::finite_number("azimuth", azimuth);
  impl::number_between("elevation", elevation, -90, 90);
  if (distance)
    impl::positive_number("distance", *distance);
  else
    check_can_fit(state(), "orbit");
  Settings settings;
  settings.orbit = {azimuth, elevation};
  if (distance) settings.orbit.push_back(*distance);
  place_camera(state(), settings);
}

void Scene::fit() {
  check_can_fit(state(), "fit");
  Settings settings;
  settings.fit = true;
  place_camera(state(), settings);
}

Vec3 Scene::up() const { return impl::public_vector(state().description.up); }

void Scene::set_up(const Vec3& up) {
  impl::direction_vector("up", up);
  state().description.up = impl::vector_of(up);
  ++state().revisions.film;
}

Film Scene::film() const {
  const impl::FilmSettings& film = state().description.film;
  return {.width = film.width, .height = film.height, .pixel_bounds = film.pixel_bounds, .exposure = film.exposure};
}

void Scene::set_film(const Film& film) {
  impl::integer_between("width", film.width, 1, max_side);
  impl::integer_between("height", film.height, 1, max_side);
  if (film.width * film.height >= max_pixels) impl::refuse_argument("width", "and 'height' give 10^9 pixels or more");
  if (film.pixel_bounds) {
    const auto& [x0, x1, y0, y1] = *film.pixel_bounds;
    if (!(0 <= x0 && x0 < x1 && x1 <= film.width && 0 <= y0 && y0 < y1 && y1 <= film.height))
      impl::refuse_argument("pixel_bounds", "must be x0, x1, y0, y1 with x0 < x1 and y0 < y1 within the image");
  }
  impl::positive_number("exposure", film.exposure);
  impl::FilmSettings& present = state().description.film;
  present.width = film.width;
  present.height = film.height;
  present.pixel_bounds = film.pixel_bounds;
  present.exposure = film.exposure;
  ++state().revisions.film;
}

PixelFilter Scene::pixel_filter() const {
  const impl::Filter& f = state().description.filter;
  return {.kind = static_cast<FilterKind>(f.type),
          .x_radius = f.x_radius,
          .y_radius = f.y_radius,
          .sigma = f.sigma,
          .b = f.b,
          .c = f.c,
          .tau = f.tau};
}

void Scene::set_pixel_filter(const PixelFilter& filter) {
  impl::Filter f;
  f.type = impl::same_kind<impl::FilterType>("kind", filter.kind, filter_kinds);
  const auto radius = [](const char* name, double value) {
    if (!(value > 0 && value <= impl::max_filter_radius))
      impl::refuse_argument(name, "must be over 0 and at most 64 pixels");
    return value;
  };
  f.x_radius = radius("x_radius", filter.x_radius);
  f.y_radius = radius("y_radius", filter.y_radius);
  f.sigma = impl::positive_number("sigma", filter.sigma);
  f.b = impl::finite_number("b", filter.b);
  f.c = impl::finite_number("c", filter.c);
  f.tau = impl::positive_number("tau", filter.tau);
  state().description.filter = f;
  ++state().revisions.film;
}

RenderDefaults Scene::render_defaults() const {
  const impl::Scene& scene = state().description;
  return {.samples_per_pixel = scene.samples_per_pixel,
          .seed = scene.seed,
          .max_depth = scene.max_depth,
          .integrator = position_in<Integrator>(integrators, scene.integrator),
          .sampler = position_in<Sampler>(samplers, scene.sampler),
          .quality = scene.quality,
          .pbrt_coats = scene.coats == impl::CoatModel::pbrt};
}

void Scene::set_render_defaults(const RenderDefaults& defaults) {
  impl::Scene& scene = state().description;
  impl::integer_between("samples_per_pixel", defaults.samples_per_pixel, 1, impl::max_samples_per_pixel);
  impl::integer_between("max_depth", defaults.max_depth, 0, impl::max_bounces);
  const auto integrator = impl::same_kind<uint32_t>("integrator", defaults.integrator, integrators.size());
  const auto sampler = impl::same_kind<uint32_t>("sampler", defaults.sampler, samplers.size());
  const auto qualities = impl::qualities();
  if (!defaults.quality.empty() && std::none_of(qualities.begin(), qualities.end(), [&](const impl::Quality& quality) {
        return defaults.quality == quality.name;
      }))
    impl::refuse_argument("quality", "must be draft, good, final or empty");
  scene.quality = defaults.quality;
  scene.samples_per_pixel = defaults.samples_per_pixel;
  scene.seed = defaults.seed;
  scene.max_depth = defaults.max_depth;
  scene.sampler = samplers[sampler];
  scene.coats = defaults.pbrt_coats ? impl::CoatModel::pbrt : impl::CoatModel::lossless;
  if (scene.integrator != integrators[integrator]) scene.replaced_integrator.clear();
  scene.integrator = integrators[integrator];
  ++state().revisions.film;
}

}  // namespace ALHAZEN_NAMESPACE

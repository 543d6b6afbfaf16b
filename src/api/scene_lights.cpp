// The lights of a public scene that are not shapes.

#include <cmath>
#include <utility>

#include "alhazen/scene.h"
#include "api/caller_errors.h"
#include "api/image_texels.h"
#include "api/parts.h"
#include "io/environment.h"

namespace ALHAZEN_NAMESPACE {

namespace {

impl::Frame<double> frame_of(const Axes& axes) {
  const impl::Vec3d x = impl::finite_vector("axes", axes.x), y = impl::finite_vector("axes", axes.y),
                    z = impl::finite_vector("axes", axes.z);
  constexpr double tolerance = 1e-6;
  for (const double deviation : {dot(x, x) - 1, dot(y, y) - 1, dot(z, z) - 1, dot(x, y), dot(y, z), dot(z, x)})
    if (!(std::abs(deviation) <= tolerance))
      impl::refuse_argument("axes", "must be of unit length and perpendicular to each other");
  return {x, y, z};
}

Axes public_axes(const impl::Frame<double>& frame) {
  return {impl::public_vector(frame.tangent), impl::public_vector(frame.bitangent), impl::public_vector(frame.normal)};
}

/// What is of unit length already stays as it is.
impl::Vec3d direction_of(const Vec3& given, const impl::Light& before) {
  return given == impl::public_vector(before.direction) ? before.direction : impl::direction_vector("direction", given);
}

void describe(const PointLight& given, impl::Light& light) {
  light.kind = impl::LightKind::point;
  light.radiance = impl::light_colour("intensity", given.intensity);
  light.position = impl::finite_vector("position", given.position);
}

void describe(const SpotLight& given, impl::Light& light) {
  light.kind = impl::LightKind::spot;
  light.radiance = impl::light_colour("intensity", given.intensity);
  light.position = impl::finite_vector("position", given.position);
  light.direction = direction_of(given.direction, light);
  if (!(given.cone_angle > 0 && given.cone_angle <= 180))
    impl::refuse_argument("cone_angle", "must be over 0 and at most 180 degrees");
  if (!(given.falloff_start >= 0 && given.falloff_start <= given.cone_angle))
    impl::refuse_argument("falloff_start", "must be from 0 to 'cone_angle'");
  light.cone_angle = given.cone_angle;
  light.falloff_start = given.falloff_start;
}

void describe(const DistantLight& given, impl::Light& light) {
  light.radiance = impl::light_colour("irradiance", given.irradiance);
  light.direction = direction_of(given.direction, light);
  const bool is_sun = given.angle != 0;
  if (is_sun && !(given.angle >= 0.01 && given.angle <= 180))
    impl::refuse_argument("angle", "must be 0, or from 0.01 to 180 degrees");
  light.kind = is_sun ? impl::LightKind::sun : impl::LightKind::distant;
  if (is_sun) light.cone_angle = given.angle / 2;
}

void describe(const GoniometricLight& given, impl::Light& light) {
  light.kind = impl::LightKind::goniometric;
  light.radiance = impl::light_colour("intensity", given.intensity);
  light.position = impl::finite_vector("position", given.position);
  light.axes = frame_of(given.axes);
}

void describe(const ProjectionLight& given, impl::Light& light) {
  light.kind = impl::LightKind::projection;
  light.radiance = impl::light_colour("intensity", given.intensity);
  light.position = impl::finite_vector("position", given.position);
  light.axes = frame_of(given.axes);
  if (!(given.fov > 0 && given.fov < 180)) impl::refuse_argument("fov", "must be over 0 and under 180 degrees");
  light.fov = given.fov;
}

void describe(const ConstantInfiniteLight& given, impl::Light& light) {
  light.kind = impl::LightKind::constant_infinite;
  light.radiance = impl::light_colour("radiance", given.radiance);
}

void describe(const EnvironmentLight& given, impl::Light& light) {
  light.kind = impl::LightKind::environment;
  light.radiance = impl::light_colour("scale", given.scale);
  light.axes = frame_of(given.axes);
}

bool has_image(impl::LightKind kind) {
  return kind == impl::LightKind::environment || impl::light_traits(kind).has_image;
}

bool is_infinite(const impl::Light& light) {
  return light.kind == impl::LightKind::constant_infinite || light.kind == impl::LightKind::environment;
}

/// The image of a light of this kind, checked.
impl::ImageTexels light_image_of(impl::LightKind kind, const Pixels& pixels) {
  impl::ImageTexels map = impl::light_map_of_pixels(pixels);
  if (kind == impl::LightKind::environment) {
    const std::string fault = impl::environment_fault(map);
    if (!fault.empty()) throw InputError("'image': " + fault);
  } else if (kind == impl::LightKind::goniometric) {
    if (map.width != map.height)
      impl::refuse_argument("image", "of a goniometric light must be square (equal-area octahedral)");
    for (size_t i = 0; i + 2 < map.floats.size(); i += 3) {
      float* t = &map.floats[i];
      t[0] = t[1] = t[2] = (t[0] + t[1] + t[2]) / 3;
    }
  }
  return map;
}

bool is_given(const Pixels& image) { return !image.bytes.empty() || !image.floats.empty() || image.width != 0; }

/// Where the image of `light` is; null if it has none.
impl::ImageTexels* image_place(impl::Scene& scene, const impl::Light& light) {
  if (light.kind == impl::LightKind::environment)
    return light.environment < scene.environments.size() ? &scene.environments[light.environment] : nullptr;
  return light.image < scene.light_images.size() ? &scene.light_images[light.image] : nullptr;
}

void free_image(impl::Scene& scene, const impl::Light& light) {
  if (impl::ImageTexels* image = image_place(scene, light)) *image = {};
}

void put_image(impl::Scene& scene, impl::Light& light, impl::ImageTexels&& image) {
  if (impl::ImageTexels* place = image_place(scene, light)) {
    *place = std::move(image);
    return;
  }
  std::vector<impl::ImageTexels>& images =
      light.kind == impl::LightKind::environment ? scene.environments : scene.light_images;
  (light.kind == impl::LightKind::environment ? light.environment : light.image) = static_cast<uint32_t>(images.size());
  images.push_back(std::move(image));
}

void count_change(impl::SceneState& state, const impl::Light& light, bool changes_map = false) {
  if (changes_map && has_image(light.kind)) ++state.revisions.light_maps;
  ++(is_infinite(light) ? state.revisions.environment : state.revisions.lights);
}

LightId append_light(impl::SceneState& s, impl::Light&& light, impl::ImageTexels&& image) {
  const auto handle = static_cast<uint32_t>(s.light_places.size());
  if (has_image(light.kind)) put_image(s.description, light, std::move(image));
  s.light_places.push_back(static_cast<uint32_t>(s.description.lights.size()));
  s.description.lights.push_back(std::move(light));
  s.lights.add(handle, s.id);
  count_change(s, s.description.lights.back(), true);
  return impl::handle_of<LightId>(handle, s.lights);
}

}  // namespace

LightId Scene::add(const Light& light, const Pixels& image) {
  impl::Light described;
  std::visit([&](const auto& kind) { describe(kind, described); }, light.kind);
  described.name = light.name;
  described.where.file = light.name;
  impl::ImageTexels map;
  if (has_image(described.kind))
    map = impl::for_caller([&] { return light_image_of(described.kind, image); });
  else if (is_given(image))
    impl::refuse_argument("image", "is for goniometric, projection and environment lights alone");
  return append_light(state(), std::move(described), std::move(map));
}

Light Scene::light(LightId light) const {
  const impl::Light& l = state().description.lights[impl::index_of("light", light, state())];
  const Colour colour = impl::public_colour(l.radiance);
  const Vec3 position = impl::public_vector(l.position), direction = impl::public_vector(l.direction);
  switch (l.kind) {
    case impl::LightKind::point:
      return {PointLight{colour, position}, l.name};
    case impl::LightKind::spot:
      return {SpotLight{colour, position, direction, l.cone_angle, l.falloff_start}, l.name};
    case impl::LightKind::distant:
      return {DistantLight{colour, direction, 0}, l.name};
    case impl::LightKind::sun:
      return {DistantLight{colour, direction, 2 * l.cone_angle}, l.name};
    case impl::LightKind::goniometric:
      return {GoniometricLight{colour, position, public_axes(l.axes)}, l.name};
    case impl::LightKind::projection:
      return {ProjectionLight{colour, position, public_axes(l.axes), l.fov}, l.name};
    case impl::LightKind::environment:
      return {EnvironmentLight{colour, public_axes(l.axes)}, l.name};
    case impl::LightKind::constant_infinite:
    case impl::LightKind::triangle:
    case impl::LightKind::sphere:
    case impl::LightKind::moving_sphere:
      break;
  }
  return {ConstantInfiniteLight{colour}, l.name};
}

Pixels Scene::light_image(LightId light) const {
  const impl::Scene& scene = state().description;
  const impl::Light& l = scene.lights[impl::index_of("light", light, state())];
  if (l.kind == impl::LightKind::environment) return impl::pixels_of(scene.environments.at(l.environment));
  return impl::light_traits(l.kind).has_image ? impl::pixels_of(scene.light_images.at(l.image)) : Pixels{};
}

void Scene::set(LightId id, const Light& light, const Pixels& image) {
  impl::SceneState& s = state();
  impl::Light& present = s.description.lights[impl::index_of("light", id, s)];
  impl::Light described = present;
  std::visit([&](const auto& kind) { describe(kind, described); }, light.kind);
  described.name = light.name;
  const bool keeps_image = described.kind == present.kind && !is_given(image);
  impl::ImageTexels map;
  if (has_image(described.kind) && !keeps_image)
    map = impl::for_caller([&] { return light_image_of(described.kind, image); });
  else if (!has_image(described.kind) && is_given(image))
    impl::refuse_argument("image", "is for goniometric, projection and environment lights alone");
  count_change(s, present, !keeps_image);
  if (!keeps_image) {
    if (described.kind != present.kind) {
      free_image(s.description, present);
      described.environment = described.image = impl::no_index;
    }
    if (has_image(described.kind)) put_image(s.description, described, std::move(map));
  }
  const bool changes_group = is_infinite(present) != is_infinite(described);
  present = std::move(described);
  if (changes_group || !keeps_image) count_change(s, present, !keeps_image);
}

void Scene::remove(LightId light) {
  impl::SceneState& s = state();
  const uint32_t place = impl::index_of("light", light, s);
  std::vector<impl::Light>& lights = s.description.lights;
  count_change(s, lights[place], true);
  free_image(s.description, lights[place]);
  lights.erase(lights.begin() + place);
  for (uint32_t& other : s.light_places)
    if (other != impl::no_index && other > place) --other;
  s.light_places[impl::HandleAccess::index(light)] = impl::no_index;
}

namespace {

/// Removes the infinite lights of a scene, then adds one.
LightId replace_environment(Scene& scene, impl::SceneState& s, impl::Light&& light, impl::ImageTexels&& map) {
  for (const LightId present : scene.lights())
    if (is_infinite(s.description.lights[impl::index_of("light", present, s)])) scene.remove(present);
  return append_light(s, std::move(light), std::move(map));
}

impl::Light environment_of_map(const impl::Scene& scene, const std::string& name) {
  const impl::Camera& camera = scene.camera;
  // Cameras that are placed by default are right-handed.
  const bool is_right_handed = camera.is_default || camera.world_from_camera.start.swaps_handedness();
  EnvironmentLight environment;
  if (!is_right_handed) environment.axes.x = {0, 0, 1}, environment.axes.y = {1, 0, 0};
  impl::Light light;
  describe(environment, light);
  light.where.file = name;
  return light;
}

}  // namespace

LightId Scene::set_environment(const Colour& radiance) {
  impl::Light light;
  describe(ConstantInfiniteLight{radiance}, light);
  return replace_environment(*this, state(), std::move(light), {});
}

LightId Scene::set_environment(const Pixels& image) {
  impl::ImageTexels map = impl::for_caller([&] { return light_image_of(impl::LightKind::environment, image); });
  return replace_environment(*this, state(), environment_of_map(state().description, image.name), std::move(map));
}

LightId Scene::load_environment(const std::string& file) {
  impl::ImageTexels map = impl::for_caller([&] { return impl::read_environment({file}); });
  const std::string fault = impl::environment_fault(map);
  if (!fault.empty()) throw impl::InputError({file}, fault);
  return replace_environment(*this, state(), environment_of_map(state().description, file), std::move(map));
}

}  // namespace ALHAZEN_NAMESPACE

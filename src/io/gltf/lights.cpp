#include <algorithm>
#include <numbers>

#include "io/gltf/cameras_and_lights.h"
#include "util/quoted.h"

namespace alhazen::impl::gltf {

namespace {

constexpr double degrees_per_radian = 180 / std::numbers::pi;

void set_cone(const Document& document, const Json& description, Light& light) {
  const Json& defaults = empty_object();
  const Json* spot = document.object(description, "spot");
  const Json& cone = spot != nullptr ? *spot : defaults;
  const double inner = document.number(cone, "innerConeAngle", 0);
  const double outer = document.number(cone, "outerConeAngle", std::numbers::pi / 4);
  if (!(outer > 0 && outer <= std::numbers::pi / 2 + 1e-6))
    document.fail(cone, "\"outerConeAngle\" must be above 0 and at most pi / 2");
  if (!(inner >= 0 && inner <= outer)) document.fail(cone, "\"innerConeAngle\" must be from 0 to \"outerConeAngle\"");
  light.cone_angle = std::min(outer * degrees_per_radian, 90.0);
  light.falloff_start = std::min(inner * degrees_per_radian, light.cone_angle);
}

Light read_light(const Document& document, const Json& description, const Matrix4& world) {
  Light light;
  const std::string type = document.string(description, "type");
  if (type == "point")
    light.kind = LightKind::point;
  else if (type == "directional")
    light.kind = LightKind::distant;
  else if (type == "spot")
    light.kind = LightKind::spot;
  else
    document.fail(description,
                  "unknown \"type\" " + quoted(type) + " of a light: it may be point, directional or spot");
  if (light.kind == LightKind::spot) set_cone(document, description, light);
  const Vec3d colour = document.vec3(description, "color", {1, 1, 1});
  const double intensity = document.number(description, "intensity", 1);
  if (intensity < 0 || std::min({colour.x, colour.y, colour.z}) < 0)
    document.fail(description, "colour and intensity of a light must not be negative");
  light.radiance = colour * intensity;
  light.position = column(world, 3);
  const Vec3d z = column(world, 2);
  light.direction = length(z) > 0 ? -normalize(z) : Vec3d{0, 0, -1};
  light.where = document.place(description);
  return light;
}

}  // namespace

void add_lights(const Document& document, const Nodes& nodes, Scene& scene, std::vector<std::string>* names) {
  const Json* extension = document.extension(document.root(), "KHR_lights_punctual");
  const Json* lights = extension == nullptr ? nullptr : document.list(*extension, "lights");
  for (const uint32_t node : nodes.drawn()) {
    const Json& description = document.item("nodes", node);
    const Json* reference = document.extension(description, "KHR_lights_punctual");
    if (reference == nullptr) continue;
    const uint64_t index = document.required_whole(*reference, "light");
    if (lights == nullptr || index >= lights->items.size())
      document.fail(*reference, "index out of range: the file has " +
                                    std::to_string(lights == nullptr ? 0 : lights->items.size()) + " lights");
    const Json& light = lights->items[static_cast<size_t>(index)];
    std::string name = document.string(description, "name");
    if (name.empty()) name = document.string(light, "name");
    if (names != nullptr) names->push_back(name);
    scene.lights.push_back(read_light(document, light, nodes.world(node)));
    scene.lights.back().name = std::move(name);
    if (max_component(scene.lights.back().radiance) == 0) scene.lights.pop_back();
  }
}

}  // namespace alhazen::impl::gltf

// The values of lights.

#include "alhazen/lights.h"

#include "alhazen/scene.h"
#include "described.h"
#include "value_bindings.h"

namespace alhazen::python {

namespace {

bool has_image(const Light& light) {
  return std::holds_alternative<GoniometricLight>(light.kind) || std::holds_alternative<ProjectionLight>(light.kind) ||
         std::holds_alternative<EnvironmentLight>(light.kind);
}

void check_light(const void* data) {
  const Light& light = *static_cast<const Light*>(data);
  constexpr std::array<float, 1> texel{1};
  alhazen::Scene().add(light,
                       has_image(light) ? Pixels{.width = 1, .height = 1, .channels = 1, .floats = texel} : Pixels{});
}

template <class Kind>
void bind_light(py::module_& m, const char* name, const char* doc, std::vector<Field> fields) {
  fields.push_back(field("name", &Light::name, "by which scene.lights and light groups find it"));
  bind_value<Kind>(m, {name, doc, 0}, std::move(fields), &check_light);
}

constexpr const char* position_doc = "world space";
constexpr const char* direction_doc = "in which the light travels, in world space, of any length but 0";
constexpr const char* axes_doc = "x, y and z axis of the image, orthonormal, in world space";

}  // namespace

void bind_lights(py::module_& m) {
  py::class_<Family<Light>, Value, std::shared_ptr<Family<Light>>>(
      m, "Light",
      "The base of all lights that are not shapes. Positions and directions are in world space. A shape becomes a "
      "light\n"
      "by its emission.");
  bind_light<PointLight>(
      m, "PointLight", "A point that sends light in all directions.",
      {field("intensity", &PointLight::intensity, "W / sr"), field("position", &PointLight::position, position_doc)});
  bind_light<SpotLight>(
      m, "SpotLight", "A cone of light.",
      {field("intensity", &SpotLight::intensity, "W / sr, on the axis"),
       field("position", &SpotLight::position, position_doc), field("direction", &SpotLight::direction, direction_doc),
       field("cone_angle", &SpotLight::cone_angle, "degrees from the axis to the edge"),
       field("falloff_start", &SpotLight::falloff_start, "degrees from the axis to where it begins to fade")});
  bind_light<DistantLight>(
      m, "DistantLight", "Light from one direction, such as that of the sun.",
      {field("irradiance", &DistantLight::irradiance, "W / m^2, at normal incidence"),
       field("direction", &DistantLight::direction, direction_doc),
       field("angle", &DistantLight::angle,
             "degrees of its disk in the sky (the sun's are 0.53), from 0.01; 0: all from one direction")});
  bind_light<GoniometricLight>(
      m, "GoniometricLight",
      "A point light whose intensity is multiplied by a square image over all directions (equal-area octahedral), "
      "which\n"
      "is given when it is added: scene.add(light, image=...).",
      {field("intensity", &GoniometricLight::intensity, "W / sr, where the image is 1"),
       field("position", &GoniometricLight::position, position_doc), field("axes", &GoniometricLight::axes, axes_doc)});
  bind_light<ProjectionLight>(
      m, "ProjectionLight",
      "Projects an image along its z axis, as a slide projector. It is given when the light is added:\n"
      "scene.add(light, image=...).",
      {field("intensity", &ProjectionLight::intensity, "W / sr, on the axis where the image is 1"),
       field("position", &ProjectionLight::position, position_doc), field("axes", &ProjectionLight::axes, axes_doc),
       field("fov", &ProjectionLight::fov, "degrees over the shorter side of the image")});
  bind_light<ConstantInfiniteLight>(m, "ConstantInfiniteLight", "The same light from everywhere.",
                                    {field("radiance", &ConstantInfiniteLight::radiance, "W / (m^2 sr)")});
  bind_light<EnvironmentLight>(
      m, "EnvironmentLight",
      "Light from everywhere by an image, which is given when it is added, scene.add(light, image=...): twice as wide "
      "as\n"
      "high (equirectangular) or square (equal-area octahedral). scene.environment is simpler.",
      {field("scale", &EnvironmentLight::scale, "factor on the image's radiance, W / (m^2 sr)"),
       field("axes", &EnvironmentLight::axes, "x, y and z axis of the map, whose top is along z, in world space")});
}

std::shared_ptr<Value> light_value(const std::shared_ptr<PythonScene>& scene, Light light) {
  return std::visit(
      [&]<class Kind>(const Kind&) -> std::shared_ptr<Value> { return value_of<Kind>(scene, std::move(light)); },
      LightKind(light.kind));
}

}  // namespace alhazen::python

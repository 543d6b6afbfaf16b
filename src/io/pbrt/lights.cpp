#include "io/pbrt/lights.h"

#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "images/image.h"
#include "images/read_texture.h"
#include "io/environment.h"
#include "io/pbrt/colours.h"
#include "io/pbrt/suggestions.h"

namespace alhazen::impl::pbrt {

namespace {

using std::numbers::pi;

/// `scale` times the colour `name`, which is white by default.
Vec3d emitted_colour(const Build& build, ParameterList& list, std::string_view name) {
  return colour(build, list, name, ColourUse::illuminant, {1, 1, 1}) * list.number("scale", 1);
}

/// The factor for the watts of `power`, distributed over `measure` (steradians, or steradians times area).
double power_factor(ParameterList& list, double measure) {
  const double power = list.number("power", -1);
  return power > 0 ? power / measure : 1;
}

/// The direction from `from` to `to` in world space.
Vec3d direction_of_light(const Build& build, ParameterList& list, const Vec3d& from, const Vec3d& to) {
  const Vec3d along = build.state.ctm_start.direction(to - from);
  if (!(length_squared(along) > 0) || !std::isfinite(length_squared(along)))
    fail(list.place_of("to"), "\"from\" and \"to\" of " + list.directive() + " must be two points apart");
  return normalize(along);
}

Light read_point(Build& build, ParameterList& list) {
  Light light;
  light.kind = LightKind::point;
  light.radiance = emitted_colour(build, list, "I") * power_factor(list, 4 * pi);
  light.position = build.state.ctm_start.point(list.point("from", {}));
  return light;
}

Light read_distant(Build& build, ParameterList& list) {
  Light light;
  light.kind = LightKind::distant;
  light.radiance = emitted_colour(build, list, "L");
  const double illuminance = list.number("illuminance", -1);
  if (illuminance > 0) light.radiance *= illuminance;
  const Vec3d from = list.point("from", {}), to = list.point("to", {0, 0, 1});
  light.direction = direction_of_light(build, list, from, to);
  const double angle = list.number("angle", 0);  // which pbrt does not have
  if (angle == 0) return light;
  if (!(angle >= 0.01 && angle <= 180))
    fail(list.place_of("angle"), "\"angle\" must be 0, or from 0.01 to 180 degrees");
  light.kind = LightKind::sun;
  light.cone_angle = angle / 2;
  return light;
}

Light read_spot(Build& build, ParameterList& list) {
  Light light;
  light.kind = LightKind::spot;
  light.cone_angle = list.number("coneangle", 30);
  light.falloff_start = light.cone_angle - list.number("conedeltaangle", 5);
  if (!(light.cone_angle > 0 && light.cone_angle <= 180))
    fail(list.place_of("coneangle"), "\"coneangle\" must be over 0 and at most 180 degrees");
  if (!(light.falloff_start >= 0 && light.falloff_start <= light.cone_angle))
    fail(list.place_of("conedeltaangle"), "\"conedeltaangle\" must be from 0 to \"coneangle\"");
  const double cos_end = std::cos(light.cone_angle * pi / 180), cos_start = std::cos(light.falloff_start * pi / 180);
  // The falloff is smooth and symmetric in the cosine, so its part of the cone has half the weight.
  const double solid_angle = 2 * pi * ((1 - cos_start) + (cos_start - cos_end) / 2);
  light.radiance = emitted_colour(build, list, "I") * power_factor(list, solid_angle);
  const Vec3d from = list.point("from", {}), to = list.point("to", {0, 0, 1});
  light.position = build.state.ctm_start.point(from);
  light.direction = direction_of_light(build, list, from, to);
  return light;
}

/// The axes of a light's image in world space, orthonormalized.
Frame<double> map_axes(Build& build, const ParameterList& list) {
  const Transform& transform = build.state.ctm_start;
  const Vec3d x = transform.direction({1, 0, 0}), y = transform.direction({0, 1, 0});
  const Vec3d z = normalize(transform.direction({0, 0, 1}));
  double scale = 1;
  if (!transform.is_similarity(scale))
    build.warn(list.place(),
               "the transform of the light stretches its image; only its effect on the image's z axis "
               "and the rotation about that are used");
  const Vec3d across = normalize(x - z * dot(x, z));
  const Vec3d up = cross(z, across);
  return {across, dot(up, y) < 0 ? -up : up, z};
}

/// Reads an infinite light whose radiance is given by an image.
Light read_environment_light(Build& build, ParameterList& list, const std::string& name) {
  if (list.has("L")) fail(list.place_of("filename"), "an infinite light takes either \"L\" or \"filename\", not both");
  ImageTexels map = read_environment(build.existing_file(list.place_of("filename"), name));
  const std::string fault = environment_fault(map);
  if (!fault.empty()) fail(list.place_of("filename"), "\"" + name + "\" cannot light the scene: " + fault);
  Light light;
  light.kind = LightKind::environment;
  double scale = list.number("scale", 1);
  if (!(scale >= 0)) fail(list.place_of("scale"), "\"scale\" of an image must not be below 0");
  const double illuminance = list.number("illuminance", -1);
  if (illuminance > 0) {
    const double irradiance = upward_irradiance(map);
    if (!(irradiance > 0))
      fail(list.place_of("illuminance"), "the upper half of \"" + name + "\" is black: leave out \"illuminance\"");
    scale *= illuminance / irradiance;
  }
  light.radiance = splat(scale);
  light.axes = map_axes(build, list);
  light.environment = static_cast<uint32_t>(build.scene.environments.size());
  build.scene.environments.push_back(std::move(map));
  return light;
}

Light read_infinite(Build& build, ParameterList& list) {
  if (list.has("portal"))
    build.warn(list.place_of("portal"), "the portal of an infinite light is not used; light is sampled from all of it");
  const std::string name = list.string("filename", "");
  if (!name.empty()) return read_environment_light(build, list, name);
  Light light;
  light.radiance = emitted_colour(build, list, "L");
  const double illuminance = list.number("illuminance", -1);
  if (illuminance > 0) light.radiance *= illuminance / pi;  // of a hemisphere of radiance 1
  return light;
}

/// The image of a delta light in linear floats; if `is_grey`, its luminance is the mean of the channels.
ImageTexels read_light_image(Build& build, ParameterList& list, const std::string& name, bool is_grey) {
  const Place& place = list.place_of("filename");
  ImageTexels image = read_environment(build.existing_file(place, name));
  for (size_t i = 0; i + 2 < image.floats.size(); i += 3) {
    float* t = &image.floats[i];
    if (!std::isfinite(t[0] + t[1] + t[2]))
      fail(place, "\"" + name + "\" cannot be a light: it holds values that are infinite or not a number");
    if (is_grey) t[0] = t[1] = t[2] = (t[0] + t[1] + t[2]) / 3;
  }
  return image;
}

void add_light_image(Build& build, Light& light, ImageTexels image) {
  light.image = static_cast<uint32_t>(build.scene.light_images.size());
  build.scene.light_images.push_back(std::move(image));
}

/// The sum of `weight(x, y)` times the luminance over all texels.
template <class Weight>
double weighted_luminance(const ImageTexels& image, const Weight& weight) {
  double sum = 0;
  const float* t = image.floats.data();
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x, t += 3)
      sum += weight(x, y) *
             luminance(Vec3d{static_cast<double>(t[0]), static_cast<double>(t[1]), static_cast<double>(t[2])});
  return sum;
}

/// The factor for `power` distributed over an image whose integral over solid angle is `measure`.
double image_power_factor(ParameterList& list, double measure) {
  if (list.number("power", -1) > 0 && !(measure > 0))
    fail(list.place_of("power"), "the image of " + list.directive() + " is black: leave out \"power\"");
  return power_factor(list, measure);
}

Light read_goniometric(Build& build, ParameterList& list) {
  const std::string name = list.string("filename", "");
  if (name.empty()) {
    build.warn(list.place(), list.directive() + " has no \"filename\"; it emits equally in all directions");
    return read_point(build, list);
  }
  ImageTexels image = read_light_image(build, list, name, true);
  if (image.width != image.height)
    fail(list.place_of("filename"), "\"" + name + "\" has " + std::to_string(image.width) + " x " +
                                        std::to_string(image.height) +
                                        " pixels; the image of a goniometric light is square (equal-area octahedral)");
  Light light;
  light.kind = LightKind::goniometric;
  const double texels = static_cast<double>(image.width) * image.height;
  const double mean = weighted_luminance(image, [](int, int) { return 1; }) / texels;
  light.radiance = emitted_colour(build, list, "I") * image_power_factor(list, 4 * pi * mean);
  light.position = build.state.ctm_start.point({});
  // The image's z is the light's y: the format rotates it so that images are upright.
  const Frame<double> axes = map_axes(build, list);
  light.axes = {axes.tangent, axes.normal, axes.bitangent};
  add_light_image(build, light, std::move(image));
  return light;
}

Light read_projection(Build& build, ParameterList& list) {
  const std::string name = list.string("filename", "");
  if (name.empty()) fail(list.place(), list.directive() + " needs a \"filename\": the image that it projects");
  Light light;
  light.kind = LightKind::projection;
  light.fov = list.number("fov", 90);
  if (!(light.fov > 0 && light.fov < 180)) fail(list.place_of("fov"), "\"fov\" must be over 0 and under 180 degrees");
  ImageTexels image = read_light_image(build, list, name, false);
  const double half = std::tan(light.fov * pi / 360), texel = 2 * half / std::min(image.width, image.height);
  const double measure = weighted_luminance(image, [&](int x, int y) {
    const double px = (x + 0.5 - image.width / 2.0) * texel, py = (y + 0.5 - image.height / 2.0) * texel;
    return texel * texel / std::pow(1 + px * px + py * py, 1.5);
  });
  light.radiance = splat(list.number("scale", 1) * image_power_factor(list, measure));
  light.position = build.state.ctm_start.point({});
  light.axes = map_axes(build, list);
  add_light_image(build, light, std::move(image));
  return light;
}

/// Reads the image of an area light as a texture with clamped edges.
void read_emission_image(Build& build, ParameterList& list, const std::string& name, AreaLight& light) {
  const Place& place = list.place_of("filename");
  const InputPath path = build.existing_file(place, name);
  const auto [entry, is_new] =
      build.images_by_key.try_emplace({path.name, static_cast<int>(TextureEncoding::automatic), false}, 0u);
  if (is_new) {
    entry->second = static_cast<uint32_t>(build.scene.images.size());
    build.scene.images.push_back(read_texture(path, TextureEncoding::automatic));
  }
  const auto [mean, is_new_mean] = build.image_means.try_emplace(path.name, 0.0);
  if (is_new_mean) {
    const ImageTexels image = read_light_image(build, list, name, false);
    mean->second =
        weighted_luminance(image, [](int, int) { return 1; }) / (static_cast<double>(image.width) * image.height);
  }
  light.image_mean = mean->second;
  if (light.power > 0 && !(light.image_mean > 0)) fail(place, "\"" + name + "\" is black: leave out \"power\"");
  Texture texture;
  texture.name = name;
  texture.kind = TextureKind::image;
  texture.wrap = WrapMode::clamp;
  texture.image = entry->second;
  light.texture = static_cast<uint32_t>(build.scene.textures.size());
  build.scene.textures.push_back(std::move(texture));
}

using LightReader = Light (*)(Build&, ParameterList&);
const std::map<std::string, LightReader> light_readers{
    {"point", read_point},       {"distant", read_distant},         {"spot", read_spot},
    {"infinite", read_infinite}, {"goniometric", read_goniometric}, {"projection", read_projection}};

}  // namespace

void add_light(Build& build, const std::string& kind, ParameterList& list) {
  list.inherit(build.state.defaults.light);
  const auto reader = light_readers.find(kind);
  if (reader == light_readers.end()) {
    std::vector<std::string> kinds;
    for (const auto& [known, function] : light_readers) kinds.push_back(known);
    fail(list.place(), "unknown light \"" + kind + "\"" + suggestion(kind, kinds));
  }
  if (build.open_object != 0)
    build.warn(list.place(), "a light in an object is not part of it; it is placed once, where it is defined");
  if (build.state.ctm().is_moving())
    build.warn(list.place(), "moving lights are not supported; a light has its position at the start");
  Light light = reader->second(build, list);
  list.reject_unknown();
  if (!is_finite(light.radiance) || !is_finite(light.position))
    fail(list.place(), list.directive() + ": its emission or position is too large for double precision");
  light.where = list.place().location();
  build.scene.lights.push_back(std::move(light));
}

void set_area_light(Build& build, const std::string& kind, ParameterList& list) {
  list.inherit(build.state.defaults.light);
  if (kind != "diffuse")
    fail(list.place(), "unknown area light \"" + kind + "\"" + or_upgrade(kind, "; the format has \"diffuse\" only"));
  AreaLight light;
  light.place = list.place();
  light.two_sided = list.boolean("twosided", false);
  light.power = list.number("power", -1);
  const std::string name = list.string("filename", "");
  if (!name.empty() && list.has("L"))
    fail(list.place_of("filename"), "an area light takes either \"L\" or \"filename\", not both");
  if (!name.empty()) read_emission_image(build, list, name, light);
  light.radiance = emitted_colour(build, list, "L");
  if (!is_finite(light.radiance)) fail(list.place(), list.directive() + ": its emission is too large");
  list.reject_unknown();
  build.state.area_light = std::move(light);
}

}  // namespace alhazen::impl::pbrt

#include "io/mitsuba/emitters.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "io/environment.h"
#include "io/mitsuba/textures.h"
#include "util/quoted.h"
#include "util/suggestion.h"

namespace alhazen::impl::mitsuba {

namespace {

using std::numbers::pi;

Vec3d emission(Build& build, ObjectReader& reader, const char* name) {
  return colour(build, reader, name, ColourUse::unbounded, {1, 1, 1});
}

Vec3d direction_of(ObjectReader& reader, const Transform& world, const char* parameter) {
  const Vec3d along = world.direction({0, 0, 1});
  if (!(length_squared(along) > 0) || !std::isfinite(length_squared(along)))
    fail(reader.place_of(parameter), reader.name() + " has no direction");
  return normalize(along);
}

bool read_point(Build& build, ObjectReader& reader, Light& light) {
  light.kind = LightKind::point;
  light.radiance = emission(build, reader, "intensity");
  if (reader.has("position") && reader.has("to_world"))
    fail(reader.place_of("position"), "a point light takes either 'position' or 'to_world'");
  light.position = reader.has("position") ? reader.vector("position", {}) : reader.transform("to_world").point({});
  return true;
}

bool read_directional(Build& build, ObjectReader& reader, Light& light) {
  light.kind = LightKind::distant;
  light.radiance = emission(build, reader, "irradiance");
  if (!reader.has("direction")) {
    light.direction = direction_of(reader, reader.transform("to_world"), "to_world");
    return true;
  }
  if (reader.has("to_world"))
    fail(reader.place_of("direction"), "a directional light takes either 'direction' or 'to_world'");
  const Vec3d along = reader.vector("direction", {});
  if (!(length_squared(along) > 0)) fail(reader.place_of("direction"), "'direction' has no length");
  light.direction = normalize(along);
  return true;
}

/// The image that a spot light projects as it falls on a square about its axis, out to the angle of its cone: with as
/// many rows as columns, and with the falloff between `falloff_start` and `cone_angle`, linear in the angle.
ImageTexels spot_image(const ImageTexels& image, const Light& light) {
  constexpr int least = 512, most = 4096;  // for a round edge; a long narrow image must not become a huge square
  const int side = std::min(std::max({image.width, image.height, least}), most);
  ImageTexels spot;
  spot.width = spot.height = side;
  spot.srgb = false;
  spot.name = image.name;
  spot.floats.reserve(3 * static_cast<size_t>(side) * static_cast<size_t>(side));
  const double reach = std::tan(light.cone_angle * pi / 180);
  const auto source = [side](int at, int count) { return static_cast<int>((at + 0.5) * count / side); };
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const double across = (2 * (x + 0.5) / side - 1) * reach, up = (2 * (y + 0.5) / side - 1) * reach;
      const double angle = std::atan(std::hypot(across, up)) * 180 / pi;
      double falloff = angle <= light.falloff_start ? 1 : 0;
      if (angle > light.falloff_start && angle < light.cone_angle)
        falloff = (light.cone_angle - angle) / (light.cone_angle - light.falloff_start);
      const auto row = static_cast<size_t>(source(y, image.height)), width = static_cast<size_t>(image.width);
      const float* texel = &image.floats[3 * (row * width + static_cast<size_t>(source(x, image.width)))];
      for (int channel = 0; channel < 3; ++channel)
        spot.floats.push_back(static_cast<float>(falloff * static_cast<double>(texel[channel])));
    }
  return spot;
}

void project_image(Build& build, ObjectReader& reader, const Transform& world, Light& light) {
  const Property& texture = *reader.find("texture");
  if (is_constant_colour(build, texture) || build.object(texture).type != "bitmap")
    fail(texture.place, "'texture' of a spot light must be a bitmap");
  ObjectReader bitmap(build.document, texture.object);
  const InputPath path = build.document.existing_file(bitmap.place_of("filename"), bitmap.text("filename", ""));
  bitmap.ignore({"raw", "filter_type", "wrap_mode", "format", "accel"});
  bitmap.reject_unknown();
  const ImageTexels image = read_environment(path);
  for (const float value : image.floats)
    if (!std::isfinite(value)) fail(texture.place, "the image of a light has values that are not finite");
  light.kind = LightKind::projection;
  light.fov = 2 * light.cone_angle;
  light.axes = {normalize(world.direction({1, 0, 0})), normalize(world.direction({0, 1, 0})), light.direction};
  light.image = static_cast<uint32_t>(build.scene.light_images.size());
  build.scene.light_images.push_back(spot_image(image, light));
}

bool read_spot(Build& build, ObjectReader& reader, Light& light) {
  light.kind = LightKind::spot;
  light.radiance = emission(build, reader, "intensity");
  light.cone_angle = reader.number("cutoff_angle", 20);
  if (!(light.cone_angle > 0 && light.cone_angle < 90))
    fail(reader.place_of("cutoff_angle"), "'cutoff_angle' must be over 0 and under 90 degrees");
  light.falloff_start = reader.number("beam_width", light.cone_angle * 3 / 4);
  if (!(light.falloff_start >= 0 && light.falloff_start <= light.cone_angle))
    fail(reader.place_of("beam_width"), "'beam_width' must be from 0 to 'cutoff_angle'");
  const Transform world = reader.transform("to_world");
  light.position = world.point({});
  light.direction = direction_of(reader, world, "to_world");
  if (reader.has("texture"))
    project_image(build, reader, world, light);
  else if (light.falloff_start < light.cone_angle)
    build.warn(reader.place(),
               "between 'beam_width' and 'cutoff_angle' the light of a spot falls off smoothly here, and "
               "linearly with the angle in Mitsuba");
  return true;
}

bool read_constant(Build& build, ObjectReader& reader, Light& light) {
  light.kind = LightKind::constant_infinite;
  light.radiance = emission(build, reader, "radiance");
  reader.ignore({"to_world"});
  return true;
}

/// The axes of a map in world space, orthonormalized. Its top is +y; its left edge is -z, and a quarter of its width
/// further +x.
Frame<double> map_axes(Build& build, ObjectReader& reader) {
  const Transform world = reader.transform("to_world");
  double scale = 1;
  if (!world.is_similarity(scale))
    build.warn(reader.place_of("to_world"),
               "the transform of the environment map stretches it, which is not supported; its "
               "effect on the directions to the top and to the left edge is used");
  const Vec3d top = normalize(world.direction({0, 1, 0})), quarter = world.direction({1, 0, 0});
  Vec3d left = world.direction({0, 0, -1});
  left = normalize(left - top * dot(left, top));
  const Vec3d side = cross(top, left);
  return {left, dot(side, quarter) < 0 ? -side : side, top};
}

bool read_environment_map(Build& build, ObjectReader& reader, Light& light) {
  if (!reader.has("filename")) fail(reader.place(), reader.name() + " needs <string name=\"filename\" value=\"...\"/>");
  const std::string name = reader.text("filename", "");
  ImageTexels map = read_environment(build.document.existing_file(reader.place_of("filename"), name));
  if (map.width != 2 * map.height)
    fail(reader.place_of("filename"), "the image has " + std::to_string(map.width) + " x " +
                                          std::to_string(map.height) +
                                          " pixels; an environment map is twice as wide as high: scale it");
  const std::string fault = environment_fault(map);
  if (!fault.empty()) fail(reader.place_of("filename"), "\"" + name + "\" cannot light the scene: " + fault);
  const double scale = reader.number("scale", 1);
  if (!(scale >= 0)) fail(reader.place_of("scale"), "'scale' of an environment map must not be below 0");
  light.kind = LightKind::environment;
  light.radiance = splat(scale);
  light.axes = map_axes(build, reader);
  light.environment = static_cast<uint32_t>(build.scene.environments.size());
  build.scene.environments.push_back(std::move(map));
  reader.ignore({"mis_compensation"});
  return true;
}

bool omit(Build& build, ObjectReader& reader, Light&) {
  build.warn(reader.place(), "the emitter " + quoted(reader.object().type) + " is not supported; it is omitted");
  reader.ignore_all();
  return false;
}

bool refuse_area(Build&, ObjectReader& reader, Light&) {
  fail(reader.place(), "an area light must be in the shape that emits");
}

using EmitterReader = bool (*)(Build&, ObjectReader&, Light&);
const std::map<std::string, EmitterReader> emitter_readers{{"point", read_point},
                                                           {"spot", read_spot},
                                                           {"directional", read_directional},
                                                           {"constant", read_constant},
                                                           {"envmap", read_environment_map},
                                                           {"area", refuse_area},
                                                           {"projector", omit},
                                                           {"sunsky", omit},
                                                           {"sun", omit},
                                                           {"sky", omit},
                                                           {"timed_sunsky", omit},
                                                           {"volumelight", omit}};

}  // namespace

void add_emitter(Build& build, const Property& property) {
  ObjectReader reader(build.document, property.object);
  const std::string& type = reader.object().type;
  const auto known = emitter_readers.find(type);
  if (known == emitter_readers.end()) {
    std::vector<std::string> types;
    for (const auto& [name, each] : emitter_readers) types.push_back(name);
    fail(reader.place(), "unknown emitter " + quoted(type) + suggestion(type, types));
  }
  Light light;
  light.name = reader.object().id;
  light.where = reader.place().location();
  if (!known->second(build, reader, light)) return;
  for (const Property* medium : reader.objects("medium"))
    build.warn(medium->place, "participating media are not supported; they are omitted");
  reader.ignore({"sampling_weight"});
  reader.reject_unknown();
  if (!is_finite(light.radiance) || !is_finite(light.position))
    fail(reader.place(), reader.name() + ": its emission or position is too large for double precision");
  build.scene.lights.push_back(std::move(light));
}

}  // namespace alhazen::impl::mitsuba

#include "io/environment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/lights/sphere_mapping.h"
#include "images/image.h"
#include "images/read_texture.h"

namespace alhazen::impl {

namespace {

void decode_bytes(ImageTexels& map) {
  std::array<float, 256> decoded{};
  for (size_t i = 0; i < 256; ++i) decoded[i] = static_cast<float>(srgb_decode(static_cast<double>(i) / 255));
  map.floats.resize(map.bytes.size());
  std::transform(map.bytes.begin(), map.bytes.end(), map.floats.begin(), [&](uint8_t byte) { return decoded[byte]; });
  std::vector<uint8_t>().swap(map.bytes);
}

}  // namespace

ImageTexels read_environment(const InputPath& path) {
  ImageTexels map = read_texture(path, TextureEncoding::automatic);
  if (map.floats.empty()) decode_bytes(map);
  map.srgb = false;
  for (float& value : map.floats)
    if (value < 0) value = 0;
  return map;
}

std::string environment_fault(const ImageTexels& map) {
  if (map.width != map.height && map.width != 2 * map.height)
    return "the image has " + std::to_string(map.width) + " x " + std::to_string(map.height) +
           " pixels; an environment map is square (equal-area octahedral) or twice as wide as high "
           "(equirectangular): convert or scale it";
  const auto odd = std::find_if(map.floats.begin(), map.floats.end(), [](float v) { return !std::isfinite(v); });
  if (odd == map.floats.end()) return {};
  const auto texel = static_cast<size_t>(odd - map.floats.begin()) / 3, width = static_cast<size_t>(map.width);
  return "the image has a value that is infinite or not a number at column " + std::to_string(texel % width) +
         ", row " + std::to_string(texel / width) + ": replace it by a finite one";
}

double upward_irradiance(const ImageTexels& map) {
  const SphereMapping mapping = map.width == map.height ? SphereMapping::octahedral : SphereMapping::equirectangular;
  // Small maps are integrated at several points per texel, since the horizon cuts through texels.
  const int parts = std::max(1, 512 / map.height);
  const double width = static_cast<double>(map.width) * parts, height = static_cast<double>(map.height) * parts;
  const auto weight = [&](int x, int y) {
    const Vec3d d = direction_of_square(mapping, Vec2d{(x + 0.5) / width, (y + 0.5) / height});
    return d.z > 0 ? d.z * solid_angle_of_square(mapping, d) / (width * height) : 0;
  };
  double sum = 0;
  const float* texel = map.floats.data();
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x, texel += 3) {
      double texel_weight = 0;
      for (int i = 0; i < parts * parts; ++i) texel_weight += weight(x * parts + i % parts, y * parts + i / parts);
      const Vec3d colour{static_cast<double>(texel[0]), static_cast<double>(texel[1]), static_cast<double>(texel[2])};
      sum += luminance(colour) * texel_weight;
    }
  return sum;
}

void remove_infinite_lights(Scene& scene) {
  std::erase_if(scene.lights, [](const Light& light) {
    return light.kind == LightKind::constant_infinite || light.kind == LightKind::environment;
  });
  scene.environments.clear();
}

void use_environment(Scene& scene, ImageTexels&& map, const std::string& name) {
  remove_infinite_lights(scene);
  Light light;
  light.kind = LightKind::environment;
  light.radiance = {1, 1, 1};
  light.environment = 0;
  // The map's centre is its -x; the direction to the left of it, its +y, is on the camera's left.
  const bool is_right_handed = scene.camera.world_from_camera.start.swaps_handedness();
  light.axes = {{0, 0, 1}, {is_right_handed ? -1.0 : 1.0, 0, 0}, {0, 1, 0}};
  light.where = {name};
  scene.environments.push_back(std::move(map));
  scene.lights.push_back(std::move(light));
}

void use_environment(Scene& scene, const InputPath& path) {
  ImageTexels map = read_environment(path);
  const std::string fault = environment_fault(map);
  if (!fault.empty()) throw InputError({path.name}, fault);
  use_environment(scene, std::move(map), path.name);
}

}  // namespace alhazen::impl

#pragma once

// Procedural environment maps, and scenes that they light.

#include <string>
#include <utility>

#include "images/image.h"
#include "support/compiled_scenes.h"
#include "support/random.h"

namespace alhazen::impl::test {

inline float& channel_of(ImageTexels& map, int x, int y, size_t channel) {
  return map.floats[3 * (static_cast<size_t>(y) * static_cast<size_t>(map.width) + static_cast<size_t>(x)) + channel];
}

/// A map of one colour.
inline ImageTexels even_map(int width, int height, float value) {
  return {width, height, {}, std::vector<float>(3 * static_cast<size_t>(width * height), value), false, "even"};
}

/// A sky of noise around 0.5, and one texel above the horizon with the value `sun`.
inline ImageTexels sun_map(int width, int height, float sun) {
  ImageTexels map = even_map(width, height, 0);
  Random random(11);
  for (float& value : map.floats) value = random.uniform<float>();
  for (size_t c = 0; c < 3; ++c) channel_of(map, width * 5 / 8, height * 3 / 8, c) = sun;
  return map;
}

/// Black, except for a texel at the centre and one in each corner.
inline ImageTexels lamps_map(int width, int height) {
  ImageTexels map = even_map(width, height, 0);
  for (const auto& [x, y] :
       {std::pair{0, 0}, {width - 1, 0}, {0, height - 1}, {width - 1, height - 1}, {width / 2, height / 2}})
    for (size_t c = 0; c < 3; ++c) channel_of(map, x, y, c) = 1 + static_cast<float>(c);
  return map;
}

/// Converts the texels to an image that can be written.
inline Image image_of(const ImageTexels& map) {
  Image image{map.width, map.height, {"R", "G", "B"}, std::vector<std::vector<float>>(3)};
  for (size_t i = 0; i < map.floats.size(); ++i) image.planes[i % 3].push_back(map.floats[i]);
  return image;
}

inline const Frame<double> map_as_world{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
/// A map with rotated and mirrored axes.
inline Frame<double> map_askew() {
  const Frame<double> frame = frame_about(normalize(Vec3d{0.3, -0.8, 0.4}));
  return {frame.bitangent, frame.tangent, frame.normal};
}

/// Adds a map to the lights of a scene.
inline Scene lit_by(Scene scene, ImageTexels map, const Frame<double>& axes = map_as_world, double scale = 1) {
  Light light;
  light.kind = LightKind::environment;
  light.radiance = splat(scale);
  light.axes = axes;
  light.environment = static_cast<uint32_t>(scene.environments.size());
  scene.environments.push_back(std::move(map));
  scene.lights.push_back(light);
  return scene;
}

/// A scene with only a map.
inline Scene map_alone(ImageTexels map, const Frame<double>& axes = map_as_world, double scale = 1) {
  Scene scene;
  return lit_by(std::move(scene), std::move(map), axes, scale);
}

/// Integrates `value(direction)` over the sphere, by the midpoints of side x side cells of equal area.
template <class Value>
double integral_over_sphere(int side, const Value& value) {
  double sum = 0;
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) sum += value(direction_of_octahedral(Vec2d{(i + 0.5) / side, (j + 0.5) / side}));
  return sum * 4 * pi<double> / side / side;
}

}  // namespace alhazen::impl::test

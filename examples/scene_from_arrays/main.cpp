// Makes a scene from arrays: waves of triangles, balls of three materials, a lamp and a sky. It is rendered, changed
// and rendered again.

#include <alhazen/scene.h>

#include <cmath>
#include <cstdio>
#include <exception>
#include <vector>

namespace {

/// A grid of squares over [-2, 2]^2, with waves.
alhazen::MeshId add_waves(alhazen::Scene& scene, double height) {
  constexpr uint32_t side = 65;
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  for (uint32_t j = 0; j < side; ++j)
    for (uint32_t i = 0; i < side; ++i) {
      const double x = i / 16.0 - 2, z = j / 16.0 - 2;
      for (const double value : {x, height * std::sin(5 * x) * std::cos(5 * z), z})
        positions.push_back(static_cast<float>(value));
      if (i + 1 == side || j + 1 == side) continue;
      const uint32_t corner = j * side + i;
      for (const uint32_t index : {0u, side, 1u, 1u, side, side + 1}) indices.push_back(corner + index);
    }
  return scene.add(alhazen::MeshArrays{.positions = positions, .indices = indices, .name = "waves"});
}

double mean(const alhazen::RenderedImage& image, const char* channel) {
  double sum = 0;
  const float* values = image.plane(channel);
  for (int i = 0; i < image.width * image.height; ++i) sum += double{values[i]};
  return sum / (image.width * image.height);
}

}  // namespace

int main() try {
  alhazen::Scene scene;
  const auto clay = scene.add({alhazen::Diffuse{.reflectance = {0.8, 0.5, 0.35}}, "clay"});
  const auto gold = scene.add(alhazen::Conductor::of(alhazen::Metal::gold, 0.05));
  const auto paint = scene.add(alhazen::Principled{.base_colour = {0.1, 0.2, 0.6}, .roughness = 0.3, .clearcoat = 1});
  const auto glass = scene.add(alhazen::Dielectric{.ior = 1.5});

  scene.add(alhazen::Shape{add_waves(scene, 0.05), clay});
  double x = -1.1;
  for (const auto material : {gold, paint, glass}) {
    scene.add(alhazen::Shape{alhazen::Sphere{0.45}, material, alhazen::Transform::translate({x, 0.5, 0})});
    x += 1.1;
  }
  scene.add({alhazen::PointLight{.intensity = 12, .position = {1, 3, 2}}, "lamp"});
  scene.set_environment(alhazen::Colour{0.5, 0.6, 0.8});
  scene.look_at({0, 1.6, 4}, {0, 0.4, 0});

  alhazen::Settings settings;
  settings.width = 160;
  settings.height = 90;
  settings.samples_per_pixel = 32;
  const alhazen::RenderedImage day = alhazen::render(scene, settings);

  scene.set(scene.find_material("clay"), alhazen::Diffuse{.reflectance = 0.05});
  scene.set_environment(alhazen::Colour{0.01, 0.01, 0.03});
  const alhazen::RenderedImage night = alhazen::render(scene, settings);
  for (const alhazen::Warning& warning : night.warnings) std::printf("warning: %s\n", warning.text().c_str());
  std::printf("%d x %d pixels; green is %.3f by day and %.3f by night\n", day.width, day.height, mean(day, "G"),
              mean(night, "G"));
} catch (const std::exception& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 2;
}

// Images of cylinders are those of fine meshes of them.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "parity/scenes.h"

namespace alhazen::test {

namespace {

/// 4096 flat strips, with normals and uv as of a cylinder.
Mesh strips_of(const Shape& cylinder) {
  constexpr uint32_t columns = 4096;
  Mesh mesh;
  for (uint32_t column = 0; column <= columns; ++column) {
    const double u = static_cast<double>(column) / columns;
    const double phi = u * cylinder.phi_max * std::numbers::pi / 180;
    const Vec3d normal{std::cos(phi), std::sin(phi), 0};
    for (const double z : {cylinder.z_min, cylinder.z_max}) {
      mesh.positions.push_back({normal.x * cylinder.radius, normal.y * cylinder.radius, z});
      mesh.normals.push_back(convert<float>(normal));
      mesh.uvs.push_back({static_cast<float>(u), z == cylinder.z_min ? 0.0f : 1.0f});
    }
    const uint32_t corner = 2 * column;
    if (column < columns)
      mesh.indices.insert(mesh.indices.end(), {corner, corner + 2, corner + 3, corner, corner + 3, corner + 1});
  }
  return mesh;
}

Scene with_strips(Scene scene) {
  for (ShapeGroup& group : scene.groups)
    for (Shape& shape : group.shapes) {
      if (shape.type != ShapeType::cylinder) continue;
      scene.meshes.push_back(strips_of(shape));
      shape.type = ShapeType::mesh;
      shape.mesh = static_cast<uint32_t>(scene.meshes.size() - 1);
    }
  return scene;
}

/// Each sample has the same random numbers in both images. Where a path meets a surface only in one of them, at
/// silhouettes and edges, or differs after many reflections, it has another value.
TEST(Cylinders, LookLikeFineMeshes) {
  for (const char* precision : {"float", "double"}) {
    SCOPED_TRACE(precision);
    Settings settings;
    settings.precision = precision;
    settings.width = 60, settings.height = 50;
    settings.samples_per_pixel = 64;
    settings.aovs = {"albedo", "normal", "depth"};
    const Outcome image = render_bits(parity_scene("cylinders"), settings);
    const Outcome expected = render_bits(with_strips(parity_scene("cylinders")), settings);
    ASSERT_EQ(image.channels, expected.channels);
    const size_t width = static_cast<size_t>(image.width), channels = image.channels.size();
    for (size_t c = 0; c < channels; ++c) {
      double sum = 0, expected_sum = 0;
      size_t alike = 0, all = 0;
      for (size_t i = 0; i < image.rows.size(); ++i) {
        if (i / width % channels != c) continue;
        const double a = static_cast<double>(image.rows[i]), b = static_cast<double>(expected.rows[i]);
        if (!std::isfinite(b)) continue;  // the depth of the sky
        sum += a;
        expected_sum += b;
        alike += std::abs(a - b) <= 0.02 * std::abs(b) + 0.01;
        ++all;
      }
      EXPECT_NEAR(sum, expected_sum, 0.005 * std::abs(expected_sum) + 0.001 * static_cast<double>(all))
          << image.channels[c];
      EXPECT_GT(alike, all * 9 / 10) << image.channels[c];
    }
  }
}

}  // namespace

}  // namespace alhazen::test

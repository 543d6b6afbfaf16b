// Images of cylinders and disks are those of fine meshes of them.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "parity/scenes.h"

namespace alhazen::impl::test {

namespace {

/// 4096 flat strips, with normals and uv as of the cylinder or disk.
Mesh strips_of(const Shape& shape) {
  constexpr uint32_t columns = 4096;
  Mesh mesh;
  for (uint32_t column = 0; column <= columns; ++column) {
    const double u = static_cast<double>(column) / columns;
    const double phi = u * shape.phi_max * std::numbers::pi / 180;
    const Vec3d outward{std::cos(phi), std::sin(phi), 0};
    for (const float v : {0.0f, 1.0f}) {
      const double radius = v > 0 && shape.type == ShapeType::disk ? shape.inner_radius : shape.radius;
      mesh.positions.push_back(outward * radius + Vec3d{0, 0, v > 0 ? shape.z_max : shape.z_min});
      mesh.normals.push_back(shape.type == ShapeType::disk ? Vec3f{0, 0, 1} : convert<float>(outward));
      mesh.uvs.push_back({static_cast<float>(u), v});
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
      if (shape.type != ShapeType::cylinder && shape.type != ShapeType::disk) continue;
      scene.meshes.push_back(strips_of(shape));
      shape.type = ShapeType::mesh;
      shape.mesh = static_cast<uint32_t>(scene.meshes.size() - 1);
    }
  return scene;
}

/// Each sample has the same random numbers in both images. Where a path meets a surface only in one of them, at
/// silhouettes and edges, or differs after many reflections, it has another value.
void expect_fine_meshes(const char* scene) {
  for (const char* precision : {"float", "double"}) {
    SCOPED_TRACE(precision);
    Settings settings;
    settings.precision = precision;
    settings.width = 60, settings.height = 50;
    settings.samples_per_pixel = 64;
    settings.aovs = {"albedo", "normal", "distance"};
    const Outcome image = render_bits(parity_scene(scene), settings);
    const Outcome expected = render_bits(with_strips(parity_scene(scene)), settings);
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

TEST(Cylinders, LookLikeFineMeshes) { expect_fine_meshes("cylinders"); }
TEST(Disks, LookLikeFineMeshes) { expect_fine_meshes("disks"); }

}  // namespace

}  // namespace alhazen::impl::test

// Directions to points of an image and back, areas, and texels beyond the image's edges.

#include "core/lights/sphere_mapping.h"

#include <gtest/gtest.h>

#include "core/lights/environment.h"
#include "support/environments.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

constexpr SphereMapping mappings[] = {SphereMapping::equirectangular, SphereMapping::octahedral};

template <class Real>
class SphereMappings : public ::testing::Test {};
TYPED_TEST_SUITE(SphereMappings, Reals);

TYPED_TEST(SphereMappings, ThereAndBack) {
  using Real = TypeParam;
  Random random(1);
  constexpr double tolerance = by_precision<Real>(1e-6, 2e-15);
  for (const SphereMapping mapping : mappings)
    for (int i = 0; i < 100'000; ++i) {
      const Vec3<Real> d = convert<Real>(random.on_sphere());
      const Vec2<Real> uv = square_of_direction(mapping, d);
      ASSERT_TRUE(uv.x >= 0 && uv.x <= 1 && uv.y >= 0 && uv.y <= 1);
      const Vec3<Real> back = direction_of_square(mapping, uv);
      ASSERT_NEAR(static_cast<double>(length(back)), 1, tolerance);
      ASSERT_LT(static_cast<double>(length(back - d)), tolerance) << d.x << " " << d.y << " " << d.z;
    }
}

TYPED_TEST(SphereMappings, OfTheAxes) {
  using Real = TypeParam;
  const auto expect = [](const Vec2<Real>& uv, double u, double v) {
    EXPECT_NEAR(static_cast<double>(uv.x), u, 1e-6);
    EXPECT_NEAR(static_cast<double>(uv.y), v, 1e-6);
  };
  const Real diagonal = std::sqrt(Real(0.5));
  // pbrt-v4's square: x to the right, y down, z at the centre.
  expect(octahedral_of_direction(Vec3<Real>{0, 0, 1}), 0.5, 0.5);
  expect(octahedral_of_direction(Vec3<Real>{1, 0, 0}), 1, 0.5);
  expect(octahedral_of_direction(Vec3<Real>{-1, 0, 0}), 0, 0.5);
  expect(octahedral_of_direction(Vec3<Real>{0, 1, 0}), 0.5, 1);
  expect(octahedral_of_direction(Vec3<Real>{0, -1, 0}), 0.5, 0);
  expect(octahedral_of_direction(Vec3<Real>{diagonal, diagonal, 0}), 0.75, 0.75);
  for (const double u : {0.0, 1.0})
    for (const double v : {0.0, 1.0})
      EXPECT_NEAR(
          static_cast<double>(direction_of_octahedral(Vec2<Real>{static_cast<Real>(u), static_cast<Real>(v)}).z), -1,
          1e-6);
  expect(equirectangular_of_direction(Vec3<Real>{1, 0, 0}), 0, 0.5);
  expect(equirectangular_of_direction(Vec3<Real>{0, 1, 0}), 0.25, 0.5);
  expect(equirectangular_of_direction(Vec3<Real>{-1, 0, 0}), 0.5, 0.5);
  expect(equirectangular_of_direction(Vec3<Real>{0, -1, 0}), 0.75, 0.5);
  expect(equirectangular_of_direction(Vec3<Real>{-diagonal, 0, diagonal}), 0.5, 0.25);
}

/// The area of a small square on the sphere, by the cross product of differences.
TEST(SphereMappingAreas, AreThoseOfSmallSquares) {
  Random random(2);
  constexpr double step = 1e-5;
  for (const SphereMapping mapping : mappings)
    for (int i = 0; i < 10'000; ++i) {
      const Vec2d uv{random.between(0.001, 0.999), random.between(0.001, 0.999)};
      // The folds: the axes and the diamond.
      const double x = std::abs(2 * uv.x - 1), y = std::abs(2 * uv.y - 1);
      if (x < 1e-3 || y < 1e-3 || std::abs(x + y - 1) < 1e-3) continue;
      const auto at = [&](double du, double dv) { return direction_of_square(mapping, Vec2d{uv.x + du, uv.y + dv}); };
      const Vec3d along_u = (at(step, 0) - at(-step, 0)) / splat(2 * step);
      const Vec3d along_v = (at(0, step) - at(0, -step)) / splat(2 * step);
      const double area = solid_angle_of_square(mapping, at(0, 0));
      ASSERT_NEAR(length(cross(along_u, along_v)) / area, 1, 1e-5) << uv.x << " " << uv.y;
    }
}

/// A texel is found at its centre; radiance is continuous across edges of the image and across the folds.
TYPED_TEST(SphereMappings, LookUpsAreContinuous) {
  using Real = TypeParam;
  for (const int width : {16, 32}) {
    const ImageTexels map = sun_map(width, 16, 2);
    for (const Frame<double>& axes : {map_as_world, map_askew()}) {
      const CompiledScene<Real> scene = compiled_scene<Real>(map_alone(map, axes));
      const EnvironmentRecord<Real>& record = scene.view.environments[0];
      ImageTexels copy = map;
      for (int y = 0; y < 16; ++y)
        for (int x = 0; x < width; ++x) {
          const Vec2<Real> uv{static_cast<Real>((x + 0.5) / width), static_cast<Real>((y + 0.5) / 16)};
          const Vec3<Real> d = record.axes.to_world(direction_of_square(record.mapping, uv));
          const Vec3<Real> found = evaluate_environment(scene.view, record, d);
          ASSERT_NEAR(static_cast<double>(found.y), static_cast<double>(channel_of(copy, x, y, 1)), 1e-4);
        }
      Random random(3);
      for (int i = 0; i < 100'000; ++i) {
        const Vec3d a = random.on_sphere(), b = normalize(a + random.on_sphere() * 1e-4);
        // Rows of the equirectangular mapping end at the poles.
        if (width == 32 && std::abs(dot(a, axes.normal)) > 0.99) continue;
        const Vec3<Real> ra = evaluate_environment(scene.view, record, convert<Real>(a));
        const Vec3<Real> rb = evaluate_environment(scene.view, record, convert<Real>(b));
        ASSERT_NEAR(static_cast<double>(ra.x), static_cast<double>(rb.x), 0.02) << a.x << " " << a.y << " " << a.z;
      }
    }
  }
}

/// For NaN directions a map returns black, and no memory outside it is read.
TYPED_TEST(SphereMappings, NotANumber) {
  using Real = TypeParam;
  const Real nan = std::numeric_limits<Real>::quiet_NaN();
  for (const int width : {4, 8}) {
    const CompiledScene<Real> scene = compiled_scene<Real>(map_alone(even_map(width, 4, 1)));
    for (const Vec3<Real>& d : {Vec3<Real>{nan, 0, 1}, Vec3<Real>{0, nan, 0}, Vec3<Real>{nan, nan, nan}}) {
      EXPECT_TRUE(is_zero(evaluate_environment(scene.view, scene.view.environments[0], d)));
      EXPECT_EQ(pdf_environment(scene.view, scene.view.environments[0], Vec3<Real>{}, d), Real(0));
    }
  }
}

}  // namespace
}  // namespace alhazen::impl::test

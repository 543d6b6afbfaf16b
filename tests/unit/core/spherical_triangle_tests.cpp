// Triangles sampled by the solid angle that they subtend: the angle, the samples and their inverse.

#include "core/lights/spherical_triangle.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

template <class Real>
class SphericalTriangles : public ::testing::Test {};
TYPED_TEST_SUITE(SphericalTriangles, Reals);

TYPED_TEST(SphericalTriangles, AngleOfVector) {
  using Real = TypeParam;
  Random random(1);
  for (int i = 0; i < 100'000; ++i) {
    const Real sign = random.uniform<Real>() < Real(0.5) ? Real(-1) : Real(1);
    const Real x = sign * std::exp(20 * random.uniform<Real>() - 10), y = std::exp(20 * random.uniform<Real>() - 10);
    const double expected = std::atan2(static_cast<double>(y), static_cast<double>(x));
    ASSERT_NEAR(static_cast<double>(angle_of_vector(x, y)), expected, by_precision<Real>(3e-7, 5e-16)) << x << " " << y;
  }
  EXPECT_EQ(angle_of_vector(Real(1), Real(0)), Real(0));
  EXPECT_EQ(angle_of_vector(Real(0), Real(0)), Real(0));
  EXPECT_EQ(angle_of_vector(Real(0), Real(2)), pi<Real> / 2);
  EXPECT_EQ(angle_of_vector(Real(-2), Real(0)), pi<Real>);
}

TYPED_TEST(SphericalTriangles, SolidAngles) {
  using Real = TypeParam;
  using V = Vec3<Real>;
  const auto solid_angle = [](const V& point, const V& a, const V& b, const V& c) {
    return static_cast<double>(spherical_triangle(point, a, b, c).solid_angle);
  };
  const double tolerance = by_precision<Real>(1e-6, 1e-14);
  EXPECT_NEAR(solid_angle(V{}, V{2, 0, 0}, V{0, 3, 0}, V{0, 0, 1}), pi<double> / 2, tolerance);
  // Any order of the corners, and a distance from the origin, change nothing.
  EXPECT_NEAR(solid_angle(V{5, 5, 5}, V{5, 8, 5}, V{7, 5, 5}, V{5, 5, 6}), pi<double> / 2, tolerance);
  // A small triangle: its area over the squared distance.
  EXPECT_NEAR(solid_angle(V{}, V{0, 0, 100}, V{1, 0, 100}, V{0, 1, 100}) / 0.5e-4, 1, 1e-3);
}

TYPED_TEST(SphericalTriangles, InverseOfSamples) {
  using Real = TypeParam;
  Random random(2);
  for (int i = 0; i < 10'000; ++i) {
    const auto corner = [&] {
      const Vec2<Real> u = random.uniform_2d<Real>();
      return Vec3<Real>{2 * u.x - 1, 2 * u.y - 1, Real(0.3) + random.uniform<Real>()};
    };
    const Vec3<Real> a = corner(), b = corner(), c = corner();
    const SphericalTriangle<Real> t = spherical_triangle(Vec3<Real>{}, a, b, c);
    if (t.solid_angle < Real(0.02)) continue;
    const Vec2<Real> u = random.uniform_2d<Real>();
    const Vec2<Real> weights = sample_spherical_triangle(t, u);
    ASSERT_TRUE(weights.x >= 0 && weights.y >= 0 && weights.x + weights.y <= 1 + std::numeric_limits<Real>::epsilon());
    const Vec3<Real> direction = normalize(a * weights.x + b * weights.y + c * (1 - weights.x - weights.y));
    const Vec2<Real> inverse = invert_spherical_triangle(t, direction);
    // Close to the second corner the first number makes no difference.
    if (u.y > Real(0.01)) {
      EXPECT_NEAR(static_cast<double>(inverse.x), static_cast<double>(u.x), by_precision<Real>(5e-3, 1e-9));
    }
    EXPECT_NEAR(static_cast<double>(inverse.y), static_cast<double>(u.y), by_precision<Real>(1e-3, 1e-9));
  }
}

/// Means over the unit square of products with the density, and over samples.
TYPED_TEST(SphericalTriangles, BilinearSamplesFollowTheDensity) {
  using Real = TypeParam;
  const BilinearDensity<Real> density{{Real(0.01), Real(0.3)}, {2, Real(0.7)}};
  constexpr int count = 400;
  double sampled[3] = {}, expected[3] = {};
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j) {
      const Vec2<Real> u{(static_cast<Real>(i) + Real(0.5)) / count, (static_cast<Real>(j) + Real(0.5)) / count};
      const Vec2<Real> s = sample_bilinear(density, u);
      const double pdf = static_cast<double>(density.pdf(u));
      const auto add = [](double* sums, const Vec2<Real>& at, double weight) {
        const double x = static_cast<double>(at.x), y = static_cast<double>(at.y);
        sums[0] += weight, sums[1] += weight * x * x, sums[2] += weight * x * y;
      };
      add(sampled, s, 1);
      add(expected, u, pdf);
    }
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(sampled[k] / (count * count), expected[k] / (count * count), 1e-4) << k;
}

}  // namespace
}  // namespace alhazen::impl::test

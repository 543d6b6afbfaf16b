// Normals bent by normal maps and bump maps.

#include <gtest/gtest.h>

#include "core/materials/normal_maps.h"
#include "support/random.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

template <class Real>
class BentNormal : public ::testing::Test {};
TYPED_TEST_SUITE(BentNormal, Reals);

/// The mirror direction stays on the visible side of the surface; normals for which it is there already are unchanged.
TYPED_TEST(BentNormal, ReflectsOutwards) {
  using Real = TypeParam;
  Random random(1);
  size_t left_alone = 0, turned = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Vec3<Real> geometric = convert<Real>(random.on_sphere());
    const Vec3<Real> bent = convert<Real>(random.on_hemisphere(convert<double>(geometric)));
    const Vec3<Real> wo = convert<Real>(random.on_sphere());
    const Real seen = std::abs(dot(wo, geometric));
    if (seen < Real(1e-3)) continue;
    const Vec3<Real> n = reflecting_normal(bent, geometric, wo);
    EXPECT_NEAR(length(n), 1, 1e-5);
    const Real side = dot(wo, geometric) < 0 ? Real(-1) : Real(1);
    const auto out = [&](const Vec3<Real>& m) {
      return side * (2 * dot(m, wo) * dot(m, geometric) - dot(wo, geometric));
    };
    EXPECT_GT(out(n), Real(0));
    if (n == bent) {
      ++left_alone;
    } else {
      ++turned;
      EXPECT_LE(out(bent), Real(0.0101));
      // The change is minimal: a little less would not suffice.
      const Vec3<Real> less = normalize(lerp(n, bent, Real(0.05)));
      EXPECT_LT(out(less), Real(0.1));
    }
    if (this->HasFailure()) return;
  }
  EXPECT_GT(left_alone, 5'000u);
  EXPECT_GT(turned, 1'000u);
}

}  // namespace
}  // namespace alhazen::impl::test

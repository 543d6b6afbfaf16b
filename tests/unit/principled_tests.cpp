// The principled material at a point: what is decided while a scene is flattened is met there.

#include <gtest/gtest.h>

#include <cmath>

#include "support/layered.h"
#include "support/random.h"
#include "support/reals.h"

namespace alhazen::test {
namespace {

template <class Real>
class PrincipledOf : public ::testing::Test {};
TYPED_TEST_SUITE(PrincipledOf, Reals);

/// Bodies whose index is next to that of their surroundings, on either side of where they cease to refract: in float
/// 1.001 - 1 is less than 0.001, in double it is more.
TYPED_TEST(PrincipledOf, BodiesOfAnIndexNextToOneAreFinite) {
  using Real = TypeParam;
  Random random(1);
  for (const double around : {0.999, 0.99899, 0.99901, 1.0, 1.00099, 1.001, 1.00101})
    for (const double ior : {std::nextafter(around, 0), around, std::nextafter(around, 2),
                             static_cast<double>(std::nextafter(static_cast<float>(around), 0.0f)),
                             static_cast<double>(std::nextafter(static_cast<float>(around), 2.0f))})
      for (const double dispersion : {0.0, 1e-50, 1.0})
        for (const double anisotropy : {0.0, 0.5}) {
          PrincipledValues v;
          v.transmission = 1, v.thin = false, v.roughness = 0.9, v.ior = ior;
          v.dispersion = dispersion, v.anisotropy = anisotropy;
          if (anisotropy > 0 && ior != around) continue;
          const FlatMaterial<Real> material = principled_of<Real>(v);
          for (const double cosine : {1.0, 0.4, 0.01, -0.5}) {
            const Bsdf<Real> bsdf = material.bsdf(cosine, random.uniform<Real>());
            const Vec3<Real> wo = direction_at(bsdf.frame, cosine, 0.3);
            for (int i = 0; i < 16; ++i) {
              const Real u_lobe = random.uniform<Real>();
              const BsdfSample<Real> s = sample_bsdf(bsdf, wo, u_lobe, random.uniform_2d<Real>());
              ASSERT_TRUE(is_finite(s.weight) && std::isfinite(s.pdf)) << "index " << ior << ", cosine " << cosine;
              const BsdfValue<Real> f = evaluate_bsdf(bsdf, wo, convert<Real>(random.on_sphere()));
              ASSERT_TRUE(is_finite(f.value) && std::isfinite(f.pdf)) << "index " << ior << ", cosine " << cosine;
            }
          }
        }
}

}  // namespace
}  // namespace alhazen::test

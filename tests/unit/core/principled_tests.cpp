// The principled material at a point: decisions of the scene compiler agree with the evaluation.

#include <gtest/gtest.h>

#include <cmath>

#include "support/layered.h"
#include "support/random.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

template <class Real>
class PrincipledOf : public ::testing::Test {};
TYPED_TEST_SUITE(PrincipledOf, Reals);

/// Bodies whose index is close to that of their surroundings, on either side of the limit for refraction: in float
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
          if (anisotropy > 0 && (ior != around || dispersion > 0)) continue;
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

/// Divided by its greatest component.
Vec3d hue_of(const Vec3d& colour) { return colour * (1 / max_component(colour)); }

/// Hue of the reflection of smooth glass with a specular colour in its mirror direction.
template <class Real>
Vec3d mirrored_hue(double iridescence, double cosine, const Vec3d& specular_colour) {
  Scene scene;
  PrincipledValues v;
  v.transmission = 1, v.thin = false, v.roughness = 0, v.iridescence = iridescence;
  Material material = principled_material(scene, v);
  material.principled.specular_colour = constant_in(scene, 1);
  scene.textures[material.principled.specular_colour].value = specular_colour;
  const Bsdf<Real> bsdf = FlatMaterial<Real>(scene, material).bsdf(cosine);
  const Vec3<Real> wo = direction_at(bsdf.frame, cosine, 0.3), n = bsdf.frame.normal;
  return hue_of(convert<double>(evaluate_bsdf(bsdf, wo, n * (2 * dot(wo, n)) - wo).value));
}

/// A film over coloured glass reflects colours of its own, which already include those of the glass
/// (KHR_materials_iridescence: its reflectance replaces the interface's).
TYPED_TEST(PrincipledOf, FilmsOverColouredGlassAreNotTinted) {
  using Real = TypeParam;
  const Vec3d red{1, 0, 0};
  for (const double cosine : {0.95, 0.6, 0.3}) {
    double cos_t;
    const Vec3d film = film_reflectance(cosine, 1.3, 400.0, red * 0.04);
    const Vec3d bare = red * fresnel_dielectric(cosine, 1.5, cos_t);
    ASSERT_GT(std::max(film.y, film.z), 1e-3);
    for (const double amount : {0.0, 0.5, 1.0}) {
      const Vec3d hue = mirrored_hue<Real>(amount, cosine, red), expected = hue_of(lerp(bare, film, amount));
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(hue[c], expected[c], 0.01) << "cosine " << cosine << ", " << amount;
    }
  }
}

}  // namespace
}  // namespace alhazen::impl::test

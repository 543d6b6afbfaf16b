// Tests the Oren-Nayar material: sampling density, energy conservation, reciprocity, the albedo of the paper, and the
// Lambertian limit of roughness 0.

#include "support/density_check.h"
#include "support/layered_checks.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

template <class Real>
FlatMaterial<Real> rough_diffuse(double reflectance, double roughness) {
  Scene scene;
  Material material;
  material.kind = MaterialKind::oren_nayar;
  material.reflectance = constant_in(scene, reflectance);
  material.roughness_u = constant_in(scene, roughness);
  return {scene, material};
}

constexpr double roughnesses[] = {1e-4, 0.1, 0.5, 1};

template <class Real>
class OrenNayar : public ::testing::Test {};
TYPED_TEST_SUITE(OrenNayar, Reals);

TYPED_TEST(OrenNayar, SamplesFollowTheirDensity) {
  using Real = TypeParam;
  Random random(1);
  for (const double roughness : roughnesses) {
    const Bsdf<Real> bsdf = rough_diffuse<Real>(0.7, roughness).bsdf(1);
    ASSERT_EQ(bsdf.kind, MaterialKind::oren_nayar);
    for (const double cosine : {1.0, 0.8, 0.3, 0.05, -0.6})
      check_density(bsdf, direction_at(bsdf.frame, cosine, 0.7), random, 2 * 4 * 5,
                    "roughness " + std::to_string(roughness) + ", cosine " + std::to_string(cosine));
  }
}

/// The fit of the albedo has an error of 0.1 %.
TYPED_TEST(OrenNayar, WhiteLosesNothing) {
  using Real = TypeParam;
  Random random(2);
  for (const double roughness : roughnesses) {
    const Bsdf<Real> bsdf = rough_diffuse<Real>(1, roughness).bsdf(1);
    for (const double cosine : {1.0, 0.7, 0.4, 0.1, 0.02, -0.3}) {
      const Energy e = energy_of(bsdf, direction_at(bsdf.frame, cosine, 0.3), 65536, random);
      EXPECT_NEAR(e.mean, 1, 0.002 + 4 * e.error) << "roughness " << roughness << ", cosine " << cosine;
    }
  }
}

/// Compares the albedo for a reflectance below 1 with the closed form of single scattering (equation 17 of the paper)
/// plus multiple scattering of the rest.
TYPED_TEST(OrenNayar, AlbedoIsThatOfThePaper) {
  using Real = TypeParam;
  Random random(3);
  for (const double r : {0.3, 1.0})
    for (const double cosine : {0.9, 0.5, 0.2}) {
      const double reflectance = 0.6, a = 1 / (1 + (0.5 - 2 / (3 * pi<double>)) * r),
                   sine = safe_sqrt(1 - cosine * cosine);
      const double g =
          sine * (std::acos(cosine) - sine * cosine) + 2.0 / 3 * (sine / cosine * (1 - sine * sine * sine) - sine);
      const double single = a + r * a * g / pi<double>, mean = a * (1 + (2.0 / 3 - 28 / (15 * pi<double>)) * r);
      const double multiple = reflectance * reflectance * mean / (1 - reflectance * (1 - mean));
      const Bsdf<Real> bsdf = rough_diffuse<Real>(reflectance, r).bsdf(1);
      const Energy e = energy_of(bsdf, direction_at(bsdf.frame, cosine, 0.3), 65536, random);
      EXPECT_NEAR(e.mean, reflectance * single + multiple * (1 - single), 0.001 + 4 * e.error) << r << " " << cosine;
    }
}

/// Weights are bounded, since the density follows the shape of the lobe.
TYPED_TEST(OrenNayar, WeightsAreNearTheAlbedo) {
  using Real = TypeParam;
  Random random(4);
  for (const double roughness : roughnesses) {
    const Bsdf<Real> bsdf = rough_diffuse<Real>(1, roughness).bsdf(1);
    for (const double cosine : {1.0, 0.5, 0.1, 0.01}) {
      const Vec3<Real> wo = direction_at(bsdf.frame, cosine, 0.3);
      for (int i = 0; i < 4096; ++i) {
        const Real u_lobe = random.uniform<Real>();
        const BsdfSample<Real> s = sample_bsdf(bsdf, wo, u_lobe, random.uniform_2d<Real>());
        if (s.pdf > 0) {
          ASSERT_LT(s.weight.x, Real(2)) << "roughness " << roughness << ", cosine " << cosine;
        }
      }
    }
  }
}

TYPED_TEST(OrenNayar, Reciprocity) {
  using Real = TypeParam;
  Random random(5);
  for (const double roughness : roughnesses) {
    const Bsdf<Real> bsdf = rough_diffuse<Real>(0.7, roughness).bsdf(1);
    const Vec3<Real> n = bsdf.frame.normal;
    for (int i = 0; i < 1000; ++i) {
      const Vec3<Real> a = convert<Real>(random.on_hemisphere(convert<double>(n)));
      const Vec3<Real> b = convert<Real>(random.on_hemisphere(convert<double>(n)));
      if (dot(a, n) < Real(0.02) || dot(b, n) < Real(0.02)) continue;
      const double forth = static_cast<double>(evaluate_bsdf(bsdf, a, b).value.y / dot(b, n));
      const double back = static_cast<double>(evaluate_bsdf(bsdf, b, a).value.y / dot(a, n));
      ASSERT_NEAR(forth / back, 1, by_precision<Real>(1e-4, 1e-10));
    }
  }
}

/// At a roughness of 0 or almost 0, the BRDF is Lambertian.
TYPED_TEST(OrenNayar, SmoothIsLambert) {
  using Real = TypeParam;
  Random random(6);
  const NamedBsdf<Real> lambert = diffuse_bsdf<Real>(0.7);
  for (const double roughness : {0.0, 1e-6}) {
    const Bsdf<Real> bsdf = rough_diffuse<Real>(0.7, roughness).bsdf(1);
    for (int i = 0; i < 1000; ++i) {
      const Vec3<Real> a = convert<Real>(random.on_sphere()), b = convert<Real>(random.on_sphere());
      const BsdfValue<Real> expected = evaluate_bsdf(lambert.bsdf, a, b), value = evaluate_bsdf(bsdf, a, b);
      EXPECT_NEAR(static_cast<double>(value.value.x), static_cast<double>(expected.value.x), 1e-5);
      if (roughness == 0) {
        EXPECT_NEAR(static_cast<double>(value.pdf), static_cast<double>(expected.pdf), 1e-5);
      }
    }
  }
}

}  // namespace
}  // namespace alhazen::impl::test

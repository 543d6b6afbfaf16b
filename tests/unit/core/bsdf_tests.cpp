// BSDFs: weight, density and value are consistent; energy conservation and reciprocity.

#include <gtest/gtest.h>

#include "support/bsdfs.h"
#include "support/effort.h"
#include "support/random.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

template <class Real>
std::vector<NamedBsdf<Real>> rough_bsdfs() {
  return {diffuse_bsdf<Real>(0.7), metal_bsdf<Real>(0.05), metal_bsdf<Real>(0.3), metal_bsdf<Real>(0.8),
          glass_bsdf<Real>(0.1),   glass_bsdf<Real>(0.3),  glass_bsdf<Real>(0.6)};
}

template <class Real>
class BsdfOf : public ::testing::Test {};
TYPED_TEST_SUITE(BsdfOf, Reals);

/// weight * pdf = f |cos|, and evaluation gives the density of sampling.
TYPED_TEST(BsdfOf, SamplesFitEvaluation) {
  using Real = TypeParam;
  Random random(1);
  const double tolerance = by_precision<Real>(2e-3, 1e-9);
  for (const NamedBsdf<Real>& named : rough_bsdfs<Real>())
    for (const double cosine : cosines)
      for (const double side : {1.0, -1.0}) {
        const Vec3<Real> wo = direction_at(named.bsdf.frame, side * cosine, 2.1);
        for (int i = 0; i < 500; ++i) {
          const Real u_lobe = random.uniform<Real>();
          const BsdfSample<Real> s = sample_bsdf(named.bsdf, wo, u_lobe, random.uniform_2d<Real>());
          // For grazing directions the cosine itself is lost in rounding.
          if (!(s.pdf > 0) || abs_dot(s.direction, named.bsdf.frame.normal) < Real(1e-3)) continue;
          EXPECT_NEAR(static_cast<double>(length(s.direction)), 1, by_precision<Real>(1e-6, 1e-14));
          const BsdfValue<Real> f = evaluate_bsdf(named.bsdf, wo, s.direction);
          ASSERT_NEAR(static_cast<double>(f.pdf / s.pdf), 1, tolerance) << named.name << ", cosine " << side * cosine;
          for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(static_cast<double>(f.value[c] / (s.weight[c] * s.pdf)), 1, tolerance)
                << named.name << ", cosine " << side * cosine;
        }
      }
}

/// Mean fraction of the light that is scattered, without the change of radiance by refraction.
template <class Real>
double energy(const Bsdf<Real>& bsdf, const Vec3<Real>& wo, Random& random) {
  double sum = 0;
  constexpr int samples = 16384;
  for (int i = 0; i < samples; ++i) {
    const Real u_lobe = random.uniform<Real>();
    const BsdfSample<Real> s = sample_bsdf(bsdf, wo, u_lobe, random.uniform_2d<Real>());
    if (s.pdf > 0) sum += static_cast<double>(max_component(s.weight) * s.eta * s.eta);
  }
  return sum / samples;
}

constexpr double energy_cosines[] = {1, 0.9, 0.7, 0.5, 0.3, -0.02, -0.2, -0.45, -0.8, -0.99};

TYPED_TEST(BsdfOf, WhiteFurnaceGainsNothing) {
  using Real = TypeParam;
  Random random(2);
  std::vector<NamedBsdf<Real>> bsdfs = rough_bsdfs<Real>();
  for (const double alpha : {0.002, 0.05, 0.3, 0.8, 1.0}) {
    bsdfs.push_back(white_metal_bsdf<Real>(alpha));
    bsdfs.push_back(glass_bsdf<Real>(alpha));
    bsdfs.push_back(glass_bsdf<Real>(alpha, 0.7));
  }
  for (const NamedBsdf<Real>& named : bsdfs)
    for (const double cosine : energy_cosines) {
      const double e = energy(named.bsdf, direction_at(named.bsdf.frame, cosine, 0.3), random);
      EXPECT_LT(e, 1.01) << named.name << ", cosine " << cosine;
      EXPECT_GT(e, 0.2) << named.name << ", cosine " << cosine;
    }
}

TYPED_TEST(BsdfOf, LosslessOnesLoseNothing) {
  using Real = TypeParam;
  Random random(3);
  for (const NamedBsdf<Real>& named : {diffuse_bsdf<Real>(1), white_metal_bsdf<Real>(0), glass_bsdf<Real>(0)})
    for (const double cosine : energy_cosines)
      EXPECT_NEAR(energy(named.bsdf, direction_at(named.bsdf.frame, cosine, 0.3), random), 1, 1e-3)
          << named.name << ", cosine " << cosine;
}

/// f(wo, wi) = f(wi, wo); with refraction f(wo, wi) / eta_i^2 = f(wi, wo) / eta_o^2 for radiance.
TYPED_TEST(BsdfOf, Reciprocity) {
  using Real = TypeParam;
  Random random(4);
  size_t tested = 0;
  for (const NamedBsdf<Real>& named : rough_bsdfs<Real>()) {
    const Vec3<Real> n = named.bsdf.frame.normal;
    for (int i = 0; i < 2000; ++i) {
      const Vec3<Real> a = convert<Real>(random.on_sphere()), b = convert<Real>(random.on_sphere());
      const double forth = static_cast<double>(evaluate_bsdf(named.bsdf, a, b).value.y / abs_dot(b, n));
      const double back = static_cast<double>(evaluate_bsdf(named.bsdf, b, a).value.y / abs_dot(a, n));
      // In world space cosines below this are mostly rounding errors in float.
      if (abs_dot(a, n) < Real(0.02) || abs_dot(b, n) < Real(0.02) || forth < 1e-6) continue;
      const auto index = [&](const Vec3<Real>& w) {
        return named.bsdf.kind == MaterialKind::dielectric && dot(w, n) < 0 ? 1.5 : 1.0;
      };
      ++tested;
      ASSERT_NEAR(forth / back * sqr(index(b) / index(a)), 1, by_precision<Real>(1e-4, 1e-10)) << named.name;
    }
  }
  EXPECT_GT(tested, 3000u);
}

TYPED_TEST(BsdfOf, SmoothOnesHaveNoDensity) {
  using Real = TypeParam;
  for (const NamedBsdf<Real>& named : {metal_bsdf<Real>(0), glass_bsdf<Real>(0)}) {
    const Vec3<Real> wo = direction_at(named.bsdf.frame, 0.6, 0);
    const BsdfSample<Real> s = sample_bsdf(named.bsdf, wo, Real(0), Vec2<Real>{Real(0.3), Real(0.6)});
    EXPECT_TRUE(s.specular);
    EXPECT_TRUE(named.bsdf.is_specular());
    EXPECT_EQ(evaluate_bsdf(named.bsdf, wo, s.direction).pdf, 0);
    EXPECT_TRUE(is_zero(evaluate_bsdf(named.bsdf, wo, s.direction).value));
    // For the mirror direction the normal is the half vector.
    EXPECT_NEAR(static_cast<double>(length((s.direction + wo) * Real(0.5) - named.bsdf.frame.normal * Real(0.6))), 0,
                by_precision<Real>(1e-6, 1e-14));
  }
}

/// Snell's law: sines are proportional to the indices, and the three directions are coplanar.
TYPED_TEST(BsdfOf, SmoothRefractionFollowsSnell) {
  using Real = TypeParam;
  const NamedBsdf<Real> glass = glass_bsdf<Real>(0);
  const Vec3<Real> n = glass.bsdf.frame.normal;
  for (const double cosine : {0.9, 0.5, 0.1, -0.99, -0.9, -0.8}) {
    const Vec3<Real> wo = direction_at(glass.bsdf.frame, cosine, 1.0);
    const BsdfSample<Real> s = sample_bsdf(glass.bsdf, wo, one_minus_epsilon<Real>, Vec2<Real>{});
    const double eta = cosine > 0 ? 1.5 : 1 / 1.5;
    EXPECT_NEAR(static_cast<double>(s.eta), eta, 1e-6);
    EXPECT_LT(dot(s.direction, n) * dot(wo, n), 0);
    const double sine_in = static_cast<double>(length(cross(wo, n)));
    const double sine_out = static_cast<double>(length(cross(s.direction, n)));
    EXPECT_NEAR(sine_in, eta * sine_out, by_precision<Real>(1e-6, 1e-14));
    EXPECT_NEAR(static_cast<double>(dot(s.direction, cross(wo, n))), 0, by_precision<Real>(1e-6, 1e-14));
  }
}

}  // namespace
}  // namespace alhazen::impl::test

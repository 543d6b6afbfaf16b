// Fresnel reflectance in cases with a simple form.

#include <gtest/gtest.h>

#include "core/materials/lobes/fresnel.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

template <class Real>
class FresnelOf : public ::testing::Test {};
TYPED_TEST_SUITE(FresnelOf, Reals);

template <class Real>
double dielectric(double cosine, double eta) {
  Real cos_t;
  return static_cast<double>(fresnel_dielectric(static_cast<Real>(cosine), static_cast<Real>(eta), cos_t));
}

template <class Real>
double conductor(double cosine, double eta, double k) {
  return static_cast<double>(
      fresnel_conductor(static_cast<Real>(cosine), static_cast<Real>(eta), static_cast<Real>(k)));
}

template <class Real>
constexpr double tolerance = by_precision<Real>(1e-6, 1e-14);

TYPED_TEST(FresnelOf, NormalIncidence) {
  for (const double eta : {1.0, 1.1, 1.5, 2.4, 1 / 1.5, 0.4}) {
    EXPECT_NEAR(dielectric<TypeParam>(1, eta), sqr((eta - 1) / (eta + 1)), tolerance<TypeParam>);
    for (const double k : {0.0, 0.5, 3.0}) {
      const double expected = (sqr(eta - 1) + k * k) / (sqr(eta + 1) + k * k);
      EXPECT_NEAR(conductor<TypeParam>(1, eta, k), expected, 4 * tolerance<TypeParam>);
    }
  }
}

/// At Brewster's angle, tan = eta, none of the parallel polarization is reflected; the other half is
/// ((1 - eta^2) / (1 + eta^2))^2.
TYPED_TEST(FresnelOf, Brewster) {
  for (const double eta : {1.2, 1.5, 2.4, 1 / 1.5}) {
    const double cosine = 1 / std::sqrt(1 + eta * eta);
    EXPECT_NEAR(dielectric<TypeParam>(cosine, eta), 0.5 * sqr((1 - eta * eta) / (1 + eta * eta)),
                4 * tolerance<TypeParam>);
  }
}

TYPED_TEST(FresnelOf, TotalInternalReflection) {
  using Real = TypeParam;
  const double critical = std::sqrt(1 - 1 / sqr(1.5));
  Real cos_t = -1;
  for (const double cosine : {critical * 0.999, 0.5, 0.1, 0.0}) {
    EXPECT_EQ(fresnel_dielectric(static_cast<Real>(cosine), static_cast<Real>(1 / 1.5), cos_t), Real(1));
    EXPECT_EQ(cos_t, Real(0));
  }
  EXPECT_LT(fresnel_dielectric(static_cast<Real>(critical * 1.001), static_cast<Real>(1 / 1.5), cos_t), Real(1));
  EXPECT_GT(cos_t, Real(0));
}

TYPED_TEST(FresnelOf, Grazing) {
  EXPECT_NEAR(dielectric<TypeParam>(0, 1.5), 1, tolerance<TypeParam>);
  EXPECT_NEAR(conductor<TypeParam>(0, 1.5, 2), 1, tolerance<TypeParam>);
}

/// The same from both sides: the cosine of refraction maps one to the other.
TYPED_TEST(FresnelOf, SameFromBothSides) {
  using Real = TypeParam;
  for (const double cosine : {1.0, 0.7, 0.3, 0.05}) {
    Real cos_t, unused;
    const Real there = fresnel_dielectric(static_cast<Real>(cosine), Real(1.5), cos_t);
    const Real back = fresnel_dielectric(cos_t, 1 / Real(1.5), unused);
    EXPECT_NEAR(static_cast<double>(there), static_cast<double>(back), 20 * tolerance<TypeParam>);
  }
}

TYPED_TEST(FresnelOf, ConductorWithoutAbsorptionIsDielectric) {
  for (const double eta : {1.1, 1.5, 2.4})
    for (double cosine = 0; cosine <= 1; cosine += 1.0 / 64)
      EXPECT_NEAR(conductor<TypeParam>(cosine, eta, 0), dielectric<TypeParam>(cosine, eta), 10 * tolerance<TypeParam>)
          << "eta " << eta << ", cosine " << cosine;
}

TYPED_TEST(FresnelOf, StaysWithinZeroAndOne) {
  for (const double eta : {0.05, 0.2, 1.0, 3.0, 30.0})
    for (const double k : {0.0, 1e-3, 1.0, 10.0, 1e4})
      for (double cosine = 0; cosine <= 1; cosine += 1.0 / 128) {
        const double f = conductor<TypeParam>(cosine, eta, k);
        EXPECT_GE(f, -tolerance<TypeParam>) << eta << " " << k << " " << cosine;
        EXPECT_LE(f, 1 + tolerance<TypeParam>) << eta << " " << k << " " << cosine;
      }
}

TYPED_TEST(FresnelOf, AbsorptionForReflectance) {
  using Real = TypeParam;
  for (const double r : {0.0, 0.1, 0.5, 0.9, 0.999}) {
    const Real k = absorption_for_reflectance(static_cast<Real>(r));
    EXPECT_NEAR(static_cast<double>(fresnel_conductor(Real(1), Real(1), k)), r, 10 * tolerance<TypeParam>);
  }
}

}  // namespace
}  // namespace alhazen::impl::test

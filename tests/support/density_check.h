#pragma once

// Tests that the directions sampled by a BSDF follow its density.

#include <gtest/gtest.h>

#include <string>

#include "core/materials/bsdf.h"
#include "support/direction_histogram.h"
#include "support/effort.h"
#include "support/random.h"

namespace alhazen::impl::test {

/// Tests with chi-squared, as one of `cases` tests. The density may integrate to `slack` above 1, which is the error of
/// the quadrature.
template <class Real>
void check_density(const Bsdf<Real>& bsdf, const Vec3<Real>& wo, Random& random, size_t cases, const std::string& name,
                   size_t samples = 200'000, double slack = 2e-3) {
  DirectionHistogram histogram(
      {convert<double>(bsdf.frame.tangent), convert<double>(bsdf.frame.bitangent), convert<double>(bsdf.frame.normal)},
      pi<double>);
  for (size_t i = 0; i < effort(samples); ++i) {
    const Real u_lobe = random.uniform<Real>();
    const BsdfSample<Real> s = sample_bsdf(bsdf, wo, u_lobe, random.uniform_2d<Real>());
    if (s.pdf > 0)
      histogram.add(convert<double>(s.direction));
    else
      histogram.add_nothing();
  }
  double integral = 0;
  const ChiSquared test =
      histogram.test([&](const Vec3d& wi) { return evaluate_bsdf(bsdf, wo, convert<Real>(wi)).pdf; }, integral);
  EXPECT_LE(integral, 1 + slack) << name;
  EXPECT_GT(test.p_value, sidak(0.01, cases)) << name << ": " << test.statistic << " for " << test.degrees_of_freedom
                                              << " degrees of freedom, integral of the pdf " << integral;
}

}  // namespace alhazen::impl::test

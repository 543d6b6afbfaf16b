#pragma once

// Checks that layered materials share: how much light they send on, and that samples follow their density.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "support/direction_histogram.h"
#include "support/effort.h"
#include "support/layered.h"
#include "support/random.h"

namespace alhazen::test {

struct Energy {
  double mean, error;
};

/// Share of the light that goes on, in the strongest channel, the change of radiance by refraction undone.
template <class Real>
Energy energy_of(const Bsdf<Real>& bsdf, const Vec3<Real>& wo, int samples, Random& random) {
  double sum = 0, squares = 0;
  for (int i = 0; i < samples; ++i) {
    const Real u_lobe = random.uniform<Real>();
    const BsdfSample<Real> s = sample_bsdf(bsdf, wo, u_lobe, random.uniform_2d<Real>());
    const double e = s.pdf > 0 ? static_cast<double>(max_component(s.weight) * s.eta * s.eta) : 0;
    EXPECT_TRUE(std::isfinite(e) && e >= 0);
    sum += e, squares += e * e;
  }
  const double mean = sum / samples;
  return {mean, std::sqrt(std::max(0.0, squares / samples - mean * mean) / samples)};
}

template <class Real>
void check_density(const Bsdf<Real>& bsdf, const Vec3<Real>& wo, Random& random, size_t cases,
                   const std::string& name) {
  DirectionHistogram histogram(
      {convert<double>(bsdf.frame.tangent), convert<double>(bsdf.frame.bitangent), convert<double>(bsdf.frame.normal)},
      pi<double>);
  for (size_t i = 0; i < effort(200'000); ++i) {
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
  EXPECT_LE(integral, 1 + 2e-3) << name;
  EXPECT_GT(test.p_value, sidak(0.01, cases)) << name << ": integral of the pdf " << integral;
}

}  // namespace alhazen::test

#pragma once

// Common to the tests of layered materials: how much light they scatter.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/layered.h"
#include "support/random.h"

namespace alhazen::test {

struct Energy {
  double mean, error;
};

/// Fraction of the light that is scattered, in the strongest channel, without the change of radiance by refraction.
template <class Real>
Energy energy_of(const Bsdf<Real>& bsdf, const Vec3<Real>& wo, int samples, Random& random) {
  // Per channel: lobes of complementary colours each have weights above 1 in a channel of their own.
  Vec3d sum{}, squares{};
  for (int i = 0; i < samples; ++i) {
    const Real u_lobe = random.uniform<Real>();
    const BsdfSample<Real> s = sample_bsdf(bsdf, wo, u_lobe, random.uniform_2d<Real>());
    const Vec3d e = s.pdf > 0 ? convert<double>(s.weight) * static_cast<double>(s.eta * s.eta) : Vec3d{};
    EXPECT_TRUE(std::isfinite(max_component(e)) && e.x >= 0 && e.y >= 0 && e.z >= 0);
    sum += e, squares += e * e;
  }
  const Vec3d means = sum * (1.0 / samples);
  const int strongest = max_axis(means);
  const double mean = means[strongest];
  return {mean, std::sqrt(std::max(0.0, squares[strongest] / samples - mean * mean) / samples)};
}

}  // namespace alhazen::test

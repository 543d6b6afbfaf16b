#pragma once

// Measures how much light layered materials scatter.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/layered.h"
#include "support/random.h"

namespace alhazen::impl::test {

struct Energy {
  double mean, error;
};

/// Returns the fraction of the light that is scattered, in the strongest channel, and its standard error. The scaling
/// of radiance by refraction is removed.
template <class Real>
Energy energy_of(const Bsdf<Real>& bsdf, const Vec3<Real>& wo, int samples, Random& random) {
  // The channels are averaged separately, since lobes of complementary colours have weights above 1 in different
  // channels.
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

}  // namespace alhazen::impl::test

#pragma once

// What the tests of layered materials share: how much light they send on.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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

}  // namespace alhazen::test

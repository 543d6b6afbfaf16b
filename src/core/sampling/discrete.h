#pragma once

// Sampling of discrete distributions by their cumulative distribution.

#include <cstdint>

#include "core/math/scalar.h"

namespace ALHAZEN_CORE {

/// The i with cdf[i] <= u < cdf[i + 1]; `cdf` holds count + 1 ascending values from 0 to 1. Items of zero weight are
/// never chosen.
template <class Real>
ALHAZEN_HD uint32_t sample_cdf(const Real* cdf, uint32_t count, Real u) {
  // Selects a half by a conditional move, since a branch would be unpredictable.
  uint32_t low = 0;
  for (uint32_t left = count; left > 1;) {
    const uint32_t half = left / 2;
    low += cdf[low + half] <= u ? half : 0;
    left -= half;
  }
  return low;
}

/// Position in [0, 1) of `u` within item `i` of a cumulative distribution.
template <class Real>
ALHAZEN_HD Real position_within(const Real* cdf, uint32_t i, Real u) {
  return clamp((u - cdf[i]) / (cdf[i + 1] - cdf[i]), Real(0), one_minus_epsilon<Real>);
}

}  // namespace ALHAZEN_CORE

#pragma once

// Choice among weighted items by their cumulative distribution.

#include <cstdint>

#include "core/math/scalar.h"

namespace alhazen {

/// The i with cdf[i] <= u < cdf[i + 1]; `cdf` holds count + 1 ascending values from 0 to 1. Items of no weight are
/// never chosen.
template <class Real>
ALHAZEN_HD uint32_t sample_cdf(const Real* cdf, uint32_t count, Real u) {
  uint32_t low = 0, high = count;
  while (high - low > 1) {
    const uint32_t middle = (low + high) / 2;
    if (cdf[middle] <= u)
      low = middle;
    else
      high = middle;
  }
  return low;
}

}  // namespace alhazen

#pragma once

// Both precisions, for typed tests.

#include <gtest/gtest.h>

namespace alhazen::impl::test {

using Reals = ::testing::Types<float, double>;

/// Returns `for_float` or `for_double`, depending on Real.
template <class Real>
constexpr double by_precision(double for_float, double for_double) {
  return sizeof(Real) == sizeof(float) ? for_float : for_double;
}

}  // namespace alhazen::impl::test

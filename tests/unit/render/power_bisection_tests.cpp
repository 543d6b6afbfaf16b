// Powers by bisection of their exponent, against std::pow.

#include "render/power_bisection.h"

#include <gtest/gtest.h>

#include <cmath>

namespace alhazen::impl::test {

namespace {

TEST(PowerBisection, HasThePowersOfEveryExponent) {
  for (const double x : {1.0, 1.5, 2.0, 4.0, 256.0, 4194304.0})
    for (unsigned digits = 0; digits < 4096; digits += 7) {
      PowerBisection bisection(x);
      double exponent = 0;
      for (int i = 0; i < 12; ++i) {
        const double part = std::ldexp(0.125, -i);
        ASSERT_NEAR(bisection.next() / std::pow(x, exponent + part), 1, 1e-14);
        const bool takes_next = (digits >> i & 1) != 0;
        bisection.step(takes_next);
        exponent += takes_next ? part : 0;
        ASSERT_NEAR(bisection.power() / std::pow(x, exponent), 1, 1e-14);
      }
    }
}

}  // namespace

}  // namespace alhazen::impl::test

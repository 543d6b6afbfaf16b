// What is displayed, computed with the same bits by every machine, against the functions of the standard library.

#include "images/display/display_error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace alhazen::impl::test {

namespace {

TEST(DisplayError, PortableFunctionsAreThoseOfTheStandardLibrary) {
  double before = -1;
  for (int i = 0; i <= 100000; ++i) {
    const double linear = i * 1e-5, encoded = portable_srgb_encode(linear);
    ASSERT_NEAR(encoded, srgb_encode(linear), 2e-15) << linear;
    ASSERT_GT(encoded, before);
    before = encoded;
  }
  for (double exponent = -100; exponent <= 100; exponent += 0.0371)
    ASSERT_NEAR(portable_exp2(exponent) / std::exp2(exponent), 1, 1e-14) << exponent;
  for (double value = 1e-30; value < 1e30; value *= 1.37)
    ASSERT_NEAR(portable_log2(value), std::log2(value), 3e-14) << value;
  for (const double whole : {-100.0, -3.0, 0.0, 1.0, 100.0}) {
    EXPECT_EQ(portable_exp2(whole), std::exp2(whole));
    EXPECT_EQ(portable_log2(std::exp2(whole)), whole);
  }
}

TEST(DisplayError, IsHalfOfTheDifferenceOfWhatIsShown) {
  const DisplayCurve plain, brighter{4, ToneMap::none}, filmic{1, ToneMap::filmic};
  EXPECT_NEAR(plain.error(0.5, 0.01), (srgb_encode(0.51) - srgb_encode(0.49)) / 2, 1e-14);
  EXPECT_NEAR(brighter.error(0.125, 0.0025), plain.error(0.5, 0.01), 1e-14);
  EXPECT_EQ(plain.error(2, 0.5), 0) << "white either way";
  EXPECT_NEAR(plain.error(0.001, 1), (1 - 0) / 2.0, 1e-14) << "from black to white";
  EXPECT_GT(filmic.error(2, 0.5), 0);
}

}  // namespace

}  // namespace alhazen::impl::test

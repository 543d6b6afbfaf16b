// What is displayed, computed with the same bits by every machine, against the functions of the standard library.

#include "images/display/display_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "images/display/fitting_exposure.h"

namespace alhazen::test {

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
  for (const double whole : {-100.0, -3.0, 0.0, 1.0, 100.0}) EXPECT_EQ(portable_exp2(whole), std::exp2(whole));
}

TEST(DisplayError, IsHalfOfTheDifferenceOfWhatIsShown) {
  const DisplayCurve plain, brighter{4, ToneMap::none}, filmic{1, ToneMap::filmic};
  EXPECT_NEAR(plain.error(0.5, 0.01), (srgb_encode(0.51) - srgb_encode(0.49)) / 2, 1e-14);
  EXPECT_NEAR(brighter.error(0.125, 0.0025), plain.error(0.5, 0.01), 1e-14);
  EXPECT_EQ(plain.error(2, 0.5), 0) << "white either way";
  EXPECT_NEAR(plain.error(0.001, 1), (1 - 0) / 2.0, 1e-14) << "from black to white";
  EXPECT_GT(filmic.error(2, 0.5), 0);
}

TEST(FittingExposure, IsInWholeStopsOfTheMedian) {
  EXPECT_EQ(fitting_exposure({}), 0);
  EXPECT_EQ(fitting_exposure({1, 2, 3}), 0);
  EXPECT_EQ(fitting_exposure({3, 3, 3}), 0);
  for (const float median : {3.01f, 4.0f, 6.5f, 7.0f, 100.0f, 12345.0f})
    EXPECT_EQ(fitting_exposure({1e30f, median, 0.1f}), -std::round(std::log2(static_cast<double>(median) / 0.6)))
        << median;
}

}  // namespace

}  // namespace alhazen::test

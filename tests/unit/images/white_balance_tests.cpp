// White points, white balance, and the estimate of a light's colour.

#include "images/display/white_balance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "colour/rgb_space.h"
#include "colour/white_point.h"

namespace alhazen::impl::test {

namespace {

/// Linear sRGB, of luminance 1, of white light.
Vec3d light_of(double kelvin) {
  const Vec2d xy = white_point(kelvin);
  return xyz_to_srgb(Vec3d{xy.x, xy.y, 1 - xy.x - xy.y} / xy.y);
}

TEST(WhitePoint, IsThatOfPublishedIlluminants) {
  // Illuminant A is a black body of 2856 K; D65, D55 and D75 are daylight (CIE 15).
  const struct {
    double kelvin;
    Vec2d xy;
  } illuminants[] = {
      {2856, {0.44758, 0.40745}}, {5503, {0.33243, 0.34744}}, {6504, {0.31272, 0.32903}}, {7504, {0.29903, 0.31488}}};
  for (const auto& [kelvin, xy] : illuminants) {
    EXPECT_NEAR(white_point(kelvin).x, xy.x, 4e-4) << kelvin;
    EXPECT_NEAR(white_point(kelvin).y, xy.y, 4e-4) << kelvin;
  }
}

TEST(WhitePoint, ChangesSteadilyAndIsFoundAgain) {
  for (double kelvin = 1500; kelvin < 20000; kelvin *= 1.05) {
    const Vec2d here = white_point(kelvin), next = white_point(kelvin * 1.001);
    EXPECT_LT(std::hypot(here.x - next.x, here.y - next.y), 5e-4) << kelvin;
    EXPECT_GT(here.x, next.x) << kelvin;
    EXPECT_NEAR(nearest_white_temperature(here) / kelvin, 1, 0.03) << kelvin;
  }
}

TEST(WhiteBalance, ChangesNothingAtD65AndWhereItIsOff) {
  for (const double kelvin : {0.0, d65_temperature})
    for (const Vec3d& colour : {Vec3d{1, 1, 1}, Vec3d{0.8, 0.1, 0.4}}) {
      const Vec3d balanced = WhiteBalance(kelvin)(colour);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(balanced[c], colour[c], 1e-12) << kelvin;
    }
}

TEST(WhiteBalance, MakesItsLightWhiteAndKeepsItAsBright) {
  for (const double kelvin : {1000.0, 2000.0, 2856.0, 4500.0, 5500.0, 10000.0, 25000.0}) {
    const Vec3d white = WhiteBalance(kelvin)(light_of(kelvin));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(white[c], 1, 2e-3) << kelvin;
    EXPECT_NEAR(luminance(white), 1, 1e-3) << kelvin;
  }
  const Vec3d white = WhiteBalance(3000)(splat(1.0));
  EXPECT_GT(white.z, white.x) << "in the light of lamps, daylight is blue";
}

LightColourEstimate estimate_under(double kelvin) {
  LightColourEstimate estimate(2.5);
  // Surfaces of many colours, and a bright dot.
  for (const Vec3d& surface : {Vec3d{0.8, 0.8, 0.8}, Vec3d{0.7, 0.2, 0.1}, Vec3d{0.1, 0.6, 0.2}, Vec3d{0.1, 0.2, 0.7}})
    estimate.add(surface * max(light_of(kelvin), splat(0.0)), 1);
  estimate.add({0, 0, 1e6}, 1e-9);
  estimate.add({std::nan(""), 1, 1}, 1);
  estimate.add({5, 0, 0}, 0);
  return estimate;
}

TEST(LightColour, IsEstimatedFromTheImage) {
  for (const double kelvin : {2600.0, 3500.0, 5000.0, 6500.0, 9000.0})
    EXPECT_NEAR(estimate_under(kelvin).temperature() / kelvin, 1, 0.06) << kelvin;
  EXPECT_EQ(LightColourEstimate(1).temperature(), d65_temperature) << "of no pixels";
}

TEST(LightColour, StaysWithinItsLimits) {
  for (const Vec3d& colour : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}}) {
    LightColourEstimate estimate(1);
    estimate.add(colour, 1);
    const double kelvin = estimate.temperature();
    EXPECT_TRUE(kelvin >= LightColourEstimate::warmest && kelvin <= LightColourEstimate::coldest) << kelvin;
    EXPECT_EQ(std::fmod(kelvin, 50), 0);
  }
}

}  // namespace

}  // namespace alhazen::impl::test

// Tone maps: what holds for all of them, and values of the published formulas.

#include "images/display/tone_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alhazen::impl::test {

namespace {

constexpr ToneMap all_tone_maps[] = {ToneMap::none, ToneMap::reinhard, ToneMap::filmic, ToneMap::aces, ToneMap::agx};

double grey_after(double value, ToneMap map) { return tone_map(splat(value), map).y; }

TEST(ToneMaps, NeverDarkenWhatGetsBrighterAndStayWithinTheDisplay) {
  for (const ToneMap map : all_tone_maps) {
    double before = 0;
    for (double value = 1e-6; value < 1e6; value *= 1.01) {
      const Vec3d mapped = tone_map(splat(value), map);
      for (int c = 0; c < 3; ++c) {
        ASSERT_GE(mapped[c], 0) << to_string(map) << " of " << value;
        ASSERT_LE(mapped[c], 1) << to_string(map) << " of " << value;
        ASSERT_NEAR(mapped[c], mapped.y, 1e-3) << to_string(map) << " of the grey " << value;
      }
      ASSERT_GE(mapped.y, before) << to_string(map) << " of " << value;
      before = mapped.y;
    }
    EXPECT_GT(before, 0.999) << to_string(map) << " reaches white";
  }
}

TEST(ToneMaps, OfAnyColourAreWithinTheDisplay) {
  for (const ToneMap map : all_tone_maps)
    for (int r = -3; r <= 5; ++r)
      for (int g = -3; g <= 5; ++g)
        for (int b = -3; b <= 5; ++b) {
          const Vec3d mapped = tone_map({std::pow(10, r), std::pow(10, g), std::pow(10, b)}, map);
          for (int c = 0; c < 3; ++c) ASSERT_TRUE(mapped[c] >= 0 && mapped[c] <= 1) << to_string(map) << r << g << b;
        }
}

TEST(ToneMaps, TurnWhatIsNoColourBlackOrWhite) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const ToneMap map : all_tone_maps) {
    EXPECT_EQ(tone_map(splat(0.0), map).x, 0) << to_string(map);
    EXPECT_EQ(tone_map(splat(-1.0), map).x, 0) << to_string(map);
    EXPECT_EQ(tone_map(splat(std::nan("")), map).x, 0) << to_string(map);
    EXPECT_GT(tone_map(splat(infinity), map).x, 0.999) << to_string(map);
  }
}

TEST(ToneMaps, HaveTheValuesOfTheirFormulas) {
  EXPECT_DOUBLE_EQ(grey_after(0.18, ToneMap::none), 0.18);
  EXPECT_NEAR(grey_after(1, ToneMap::reinhard), 0.5, 1e-12);
  EXPECT_NEAR(grey_after(1, ToneMap::filmic), 2.54 / 3.16, 1e-12);
  // The rows of Hill's matrices sum to 1 within 5 digits, so a grey is that of the curve.
  EXPECT_NEAR(grey_after(1, ToneMap::aces), 1.024488063 / 1.65476, 2e-5);
  EXPECT_NEAR(grey_after(0.18, ToneMap::aces), (0.18 * 0.2045786 - 0.000090537) / (0.18 * 0.61002222 + 0.238081), 2e-5);
  // A red of 1: the columns and rows of both matrices, by hand.
  const double curve[] = {0.59719, 0.07600, 0.02840};
  double out = 0;
  const double row[] = {1.60475, -0.53108, -0.07367};
  for (int i = 0; i < 3; ++i)
    out += row[i] * (curve[i] * (curve[i] + 0.0245786) - 0.000090537) /
           (curve[i] * (0.983729 * curve[i] + 0.4329510) + 0.238081);
  EXPECT_NEAR(tone_map({1, 0, 0}, ToneMap::aces).x, out, 1e-12);
}

/// The sigmoid, by the functions of the standard library.
double agx_grey(double value) {
  const double x = std::min(1.0, std::max(0.0, (std::log2(value / 0.18) + 10) / 16.5)), pivot = 10 / 16.5;
  const double end = x < pivot ? pivot : 1 - pivot, power = x < pivot ? 3 : 3.25;
  const double scale = std::pow(std::pow(2 * end, -power) * (std::pow(2 * end / 0.5, power) - 1), -1 / power);
  const double distance = std::abs(x - pivot);
  const double y = 2 * distance / std::pow(1 + std::pow(2 * distance / scale, power), 1 / power);
  return std::pow(x < pivot ? 0.5 - y : 0.5 + y, 2.2);
}

TEST(ToneMaps, AgxIsItsSigmoid) {
  EXPECT_NEAR(grey_after(0.18, ToneMap::agx), std::pow(0.5, 2.2), 1e-4) << "middle grey is the pivot";
  for (double value = 2e-4; value < 15; value *= 1.3)
    EXPECT_NEAR(grey_after(value, ToneMap::agx), agx_grey(value), 4e-4) << value;
  EXPECT_NEAR(grey_after(0.18 * std::exp2(-10.1), ToneMap::agx), 0, 1e-12) << "below its range";
  EXPECT_NEAR(grey_after(0.18 * std::exp2(6.6), ToneMap::agx), 1, 1e-12) << "above its range";
}

/// What tells it from a curve for each channel.
TEST(ToneMaps, AgxAndAcesTurnBrightColoursToWhite) {
  for (const ToneMap map : {ToneMap::agx, ToneMap::aces}) {
    EXPECT_GT(tone_map({1000, 0, 0}, map).y, 0.3) << to_string(map);
    EXPECT_LT(tone_map({0.2, 0, 0}, map).y, 0.05) << to_string(map);
  }
}

TEST(ToneMaps, HaveNames) {
  EXPECT_EQ(tone_map_names(), "none, reinhard, filmic, aces or agx");
  for (const ToneMap map : all_tone_maps) EXPECT_EQ(tone_map_named(to_string(map)), map);
  EXPECT_EQ(tone_map_named(""), ToneMap::none);
  try {
    tone_map_named("hable");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'hable': it may be none, reinhard, filmic, aces, agx"),
              std::string::npos);
  }
}

}  // namespace

}  // namespace alhazen::impl::test

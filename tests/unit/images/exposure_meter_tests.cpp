// The exposure that an image gets by its brightness.

#include "images/display/exposure_meter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace alhazen::impl::test {

namespace {

/// A square image; a negative coverage stands for one that is not known.
struct MeteredPixel {
  double value = 0, coverage = -1;
};

template <class PixelAt>
ExposureMeter metered(int size, const PixelAt& pixel_at) {
  ExposureMeter meter(size, size, pixel_at(0, 0).coverage >= 0);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const MeteredPixel pixel = pixel_at(x, y);
      meter.add(x, y, splat(pixel.value), std::max(0.0, pixel.coverage));
    }
  return meter;
}

ExposureMeter of_grey(double value) {
  return metered(8, [&](int, int) { return MeteredPixel{value, 1}; });
}

TEST(ExposureMeter, FittingDarkensByWholeStopsOfTheMedian) {
  for (const double value : {0.0, 0.01, 1.0, 2.9}) EXPECT_EQ(of_grey(value).fitting(), 0) << value;
  for (const double value : {3.1, 4.1, 7.1, 100.0, 12345.0}) {
    const double exposure = of_grey(value).fitting();
    EXPECT_EQ(exposure, std::round(exposure));
    EXPECT_NEAR(exposure, -std::log2(value / 0.6), 0.55) << value;
  }
  ExposureMeter colour(1, 1, true);
  colour.add(0, 0, {0, 0, 100}, 1);
  EXPECT_EQ(colour.fitting(), -7) << "of the brightest channel";
}

TEST(ExposureMeter, AutomaticMakesTheImageMiddleGrey) {
  for (const double value : {1e-6, 0.02, 0.18, 1.0, 55.0, 1e7}) {
    const double exposure = of_grey(value).automatic();
    EXPECT_NEAR(exposure, std::log2(0.18 / value), 0.08) << value;
    EXPECT_NEAR(exposure * 10, std::round(exposure * 10), 1e-9) << "tenths of a stop";
  }
  EXPECT_EQ(of_grey(0).automatic(), 0);
}

/// A subject under the sun, in the middle of a background over 60 % of the image.
TEST(ExposureMeter, TheBackgroundDoesNotCount) {
  for (const double background : {0.0, 1e-3, 1.0, 3e4}) {
    for (const bool is_known : {true, false}) {
      const ExposureMeter meter = metered(40, [&](int x, int y) {
        const bool is_subject = std::abs(x - 20) < 13 && std::abs(y - 20) < 13;
        return MeteredPixel{is_subject ? 2000 : background, is_known ? (is_subject ? 1.0 : 0.0) : -1};
      });
      EXPECT_EQ(meter.fitting(), -12) << background << is_known;
      if (!is_known) continue;
      EXPECT_NEAR(meter.automatic(), std::log2(0.18 / 2000), 0.08) << background;
    }
  }
}

TEST(ExposureMeter, PixelsCountAsMuchAsTheyAreCovered) {
  const ExposureMeter meter = metered(10, [](int x, int) {
    return x < 2 ? MeteredPixel{100, 1} : MeteredPixel{1000, 0.05};
  });
  EXPECT_EQ(meter.fitting(), -7) << "2 columns of 1 are more than 8 of 0.05";
  EXPECT_TRUE(meter.uses_coverage());
  EXPECT_EQ(meter.weight(5, 5, 0.05), 0.05);
}

TEST(ExposureMeter, WhereNothingIsCoveredTheMiddleCounts) {
  const ExposureMeter meter = metered(40, [](int x, int y) {
    const bool is_middle = std::abs(x - 20) < 11 && std::abs(y - 20) < 11;
    return MeteredPixel{is_middle ? 100 : 0.1, 0};
  });
  EXPECT_FALSE(meter.uses_coverage());
  EXPECT_EQ(meter.fitting(), -7);
  EXPECT_GT(meter.weight(20, 20, 0), 0.9);
  EXPECT_LT(meter.weight(0, 20, 0), 0.05);
}

TEST(ExposureMeter, BrightDotsAndBlackDoNotCount) {
  const ExposureMeter meter = metered(40, [](int x, int y) {
    if (x == 7) return MeteredPixel{0, 1};
    if (x == y) return MeteredPixel{1e9, 1};
    if (x == 12) return MeteredPixel{std::numeric_limits<double>::infinity(), 1};
    if (x == 13) return MeteredPixel{std::nan(""), 1};
    return MeteredPixel{0.18, 1};
  });
  EXPECT_NEAR(meter.automatic(), 0, 0.11);
}

/// A dark background that is not known to be one does not make a bright subject white.
TEST(ExposureMeter, AutomaticSparesASubjectOnADarkBackground) {
  const ExposureMeter meter = metered(40, [](int x, int y) {
    const bool is_subject = std::abs(x - 20) < 9 && std::abs(y - 20) < 9;
    return MeteredPixel{is_subject ? 600 : 0.02, -1};
  });
  EXPECT_LT(meter.automatic(), std::log2(1 / 600.0) + 1.5);
}

/// Where a third of the image is far brighter than the rest, it is not all white.
TEST(ExposureMeter, AutomaticSparesHighlights) {
  const auto exposure_of_highlights = [](double brightness) {
    return metered(30, [&](int x, int) { return MeteredPixel{x < 10 ? brightness : 0.05, 1}; }).automatic();
  };
  const double mild = exposure_of_highlights(0.5), strong = exposure_of_highlights(3),
               extreme = exposure_of_highlights(1e4);
  EXPECT_GT(mild, 0);
  EXPECT_NEAR(strong, std::log2(1 / 3.0), 0.1) << "just white";
  EXPECT_GT(extreme, std::log2(1e-4) + 4) << "the rest is still seen";
}

}  // namespace

}  // namespace alhazen::impl::test

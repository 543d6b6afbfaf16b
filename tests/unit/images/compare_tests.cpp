// Image metrics: MSE, relative MSE, SSIM and FLIP, and the difference image.

#include "images/metrics/compare.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "images/metrics/ssim.h"

namespace alhazen::impl::test {
namespace {

const float nan = std::numeric_limits<float>::quiet_NaN();

Image constant_image(int width, int height, float value) {
  Image image{width, height, {"R", "G", "B"}, {}};
  image.planes.assign(3, std::vector<float>(static_cast<size_t>(width * height), value));
  return image;
}

/// Gradients under a checkerboard; `altered` has them shifted in colour, with a disc and a line.
Image pattern(int width, int height, bool altered) {
  Image image = constant_image(width, height, 0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double u = (x + 0.5) / width, v = (y + 0.5) / height;
      double red = u, green = v, blue = 0.5 + 0.5 * std::sin(20 * u * v);
      if ((x / 8 + y / 8) % 2 == 1) {
        red *= 0.3;
        blue = 1 - blue;
      }
      if (altered) green = std::min(1.0, green * 1.1 + 0.02);
      if (altered && std::hypot(u - 0.5, v - 0.5) < 0.2) {
        red = 1 - red;
        blue *= 0.5;
      }
      if (altered && x == width / 4) red = green = blue = 1;
      const size_t i = static_cast<size_t>(y * width + x);
      image.planes[0][i] = static_cast<float>(red);
      image.planes[1][i] = static_cast<float>(green);
      image.planes[2][i] = static_cast<float>(blue);
    }
  return image;
}

TEST(Compare, EqualImages) {
  const Image image = pattern(40, 30, false);
  const ImageDifference d = compare_images(image, image);
  EXPECT_EQ(d.mse, 0);
  EXPECT_EQ(d.rmse, 0);
  EXPECT_EQ(d.relmse, 0);
  EXPECT_EQ(d.relmse_trimmed, 0);
  EXPECT_TRUE(std::isinf(d.psnr) && d.psnr > 0);
  EXPECT_NEAR(d.ssim, 1, 1e-12);
  EXPECT_EQ(d.flip, 0);
  EXPECT_EQ(d.max_abs, 0);
  EXPECT_EQ(d.mean_a, d.mean_b);
  EXPECT_EQ(d.nonfinite_a + d.nonfinite_b, 0);
}

TEST(Compare, ReducedImagesAreMeansOfBlocks) {
  Image image = constant_image(5, 3, 0);
  for (size_t i = 0; i < 15; ++i) image.planes[0][i] = static_cast<float>(i);
  const Image small = reduced(image, 2);
  EXPECT_EQ(small.width, 2);
  EXPECT_EQ(small.height, 1);
  EXPECT_EQ(small.channels, image.channels);
  EXPECT_EQ(small.planes[0], (std::vector<float>{3, 5}));  // 0 1 5 6, 2 3 7 8
  EXPECT_THROW(reduced(image, 4), InputError);
}

TEST(Compare, ConstantOffset) {
  const ImageDifference d = compare_images(constant_image(16, 16, 0.75f), constant_image(16, 16, 0.5f));
  EXPECT_NEAR(d.mse, 0.0625, 1e-12);
  EXPECT_NEAR(d.rmse, 0.25, 1e-12);
  EXPECT_NEAR(d.relmse, 0.0625 / (0.25 + 0.01), 1e-12);
  EXPECT_NEAR(d.max_abs, 0.25, 1e-12);
  EXPECT_NEAR(d.mean_a, 0.75, 1e-9);
  EXPECT_NEAR(d.mean_b, 0.5, 1e-9);
  const double a = srgb_encode(0.75), b = srgb_encode(0.5);
  EXPECT_NEAR(d.psnr, -20 * std::log10(a - b), 1e-9);
  // Without variance SSIM is its luminance term alone.
  EXPECT_NEAR(d.ssim, (2 * a * b + 1e-4) / (a * a + b * b + 1e-4), 1e-7);
}

TEST(Compare, TheReferenceDividesInRelmse) {
  const Image bright = constant_image(4, 4, 2), dark = constant_image(4, 4, 1);
  EXPECT_NEAR(compare_images(bright, dark).relmse, 1 / 1.01, 1e-12);
  EXPECT_NEAR(compare_images(dark, bright).relmse, 1 / 4.01, 1e-12);
}

TEST(Compare, TrimmedRelmseLeavesOutAThousandthOfThePixels) {
  const Image black = constant_image(50, 40, 0);
  Image noisy = constant_image(50, 40, 0.1f);
  for (std::vector<float>& plane : noisy.planes) plane[7] = plane[1234] = 100;  // 2 of 2000 pixels
  const ImageDifference d = compare_images(noisy, black);
  EXPECT_NEAR(d.relmse_trimmed, 1, 1e-6);
  EXPECT_NEAR(d.relmse, (1998 + 2 * 1e6) / 2000, 1e-3);
  for (std::vector<float>& plane : noisy.planes) plane[99] = 100;  // one more than is left out
  EXPECT_NEAR(compare_images(noisy, black).relmse_trimmed, (1997 + 1e6) / 1998, 1e-3);
}

TEST(Compare, TrimmedRelmseOfFewPixelsIsRelmse) {
  const ImageDifference d = compare_images(pattern(30, 30, true), pattern(30, 30, false));
  EXPECT_DOUBLE_EQ(d.relmse_trimmed, d.relmse);
  Image none = constant_image(4, 4, 0);
  none.planes[0].assign(16, nan);
  EXPECT_TRUE(std::isnan(compare_images(none, none).relmse_trimmed));
}

TEST(Compare, MeansAreOfLuminance) {
  Image green = constant_image(2, 2, 0);
  green.planes[1].assign(4, 1);
  EXPECT_NEAR(compare_images(green, green).mean_a, 0.71517, 1e-5);
}

TEST(Compare, SizesMustAgree) {
  try {
    compare_images(constant_image(3, 4, 0), constant_image(4, 3, 0));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("3 x 4 and 4 x 3"), std::string::npos) << error.what();
  }
  EXPECT_THROW(difference_image(constant_image(3, 4, 0), constant_image(4, 3, 0)), InputError);
}

TEST(Compare, ChannelsMustBeColoursOrOneGrey) {
  const Image grey{2, 1, {"luminance"}, {{0.5f, 0.25f}}};
  const Image colour{2, 1, {"depth.Z", "B", "G", "R"}, {{9, 9}, {0.5f, 0.25f}, {0.5f, 0.25f}, {0.5f, 0.25f}}};
  EXPECT_EQ(compare_images(grey, colour).mse, 0);
  const Image neither{2, 1, {"R", "G"}, {{0, 0}, {0, 0}}};
  EXPECT_THROW(compare_images(neither, neither), InputError);
}

TEST(Compare, PixelsThatAreNotFiniteAreCountedAndLeftOut) {
  Image a = constant_image(20, 20, 0.75f), b = constant_image(20, 20, 0.5f);
  a.planes[0][5] = nan;
  a.planes[1][6] = std::numeric_limits<float>::infinity();
  b.planes[2][6] = nan;
  b.planes[2][300] = -std::numeric_limits<float>::infinity();
  const ImageDifference d = compare_images(a, b);
  EXPECT_EQ(d.nonfinite_a, 2);
  EXPECT_EQ(d.nonfinite_b, 2);
  EXPECT_NEAR(d.mse, 0.0625, 1e-12);
  EXPECT_NEAR(d.mean_a, 0.75, 1e-9);
  EXPECT_TRUE(std::isfinite(d.ssim));
  EXPECT_TRUE(std::isfinite(d.flip));
  const Image map = difference_image(a, b);
  for (const float value : map.planes[0]) EXPECT_TRUE(std::isfinite(value));
}

TEST(Compare, EqualButForNanIsStillEqual) {
  Image a = pattern(30, 30, false);
  a.planes[0][100] = nan;
  const ImageDifference d = compare_images(a, pattern(30, 30, false));
  EXPECT_EQ(d.mse, 0);
  EXPECT_NEAR(d.ssim, 1, 1e-12);
  EXPECT_EQ(d.flip, 0);
}

/// The definition, with the whole window summed at each pixel.
double direct_ssim(const Plane<double>& a, const Plane<double>& b) {
  double total = 0, count = 0;
  for (size_t y = 5; y + 5 < a.height; ++y)
    for (size_t x = 5; x + 5 < a.width; ++x) {
      double weights = 0, ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
      for (int j = -5; j <= 5; ++j)
        for (int i = -5; i <= 5; ++i) {
          const double weight = std::exp(-(i * i + j * j) / (2 * 1.5 * 1.5));
          const size_t at = (y + static_cast<size_t>(j + 5) - 5) * a.width + x + static_cast<size_t>(i + 5) - 5;
          const double va = a.values[at], vb = b.values[at];
          weights += weight;
          ma += weight * va;
          mb += weight * vb;
          aa += weight * va * va;
          bb += weight * vb * vb;
          ab += weight * va * vb;
        }
      ma /= weights, mb /= weights, aa /= weights, bb /= weights, ab /= weights;
      total += (2 * ma * mb + 1e-4) * (2 * (ab - ma * mb) + 9e-4) /
               ((ma * ma + mb * mb + 1e-4) * (aa - ma * ma + bb - mb * mb + 9e-4));
      ++count;
    }
  return total / count;
}

TEST(Compare, SsimIsThatOfItsDefinition) {
  const Image a = pattern(33, 21, true), b = pattern(33, 21, false);
  const auto encoded_luminance = [](const Image& image) {
    Plane<double> plane(static_cast<size_t>(image.width), static_cast<size_t>(image.height));
    for (size_t i = 0; i < plane.values.size(); ++i)
      plane.values[i] = srgb_encode(0.2126390059 * static_cast<double>(image.planes[0][i]) +
                                    0.7151686788 * static_cast<double>(image.planes[1][i]) +
                                    0.0721923154 * static_cast<double>(image.planes[2][i]));
    return plane;
  };
  EXPECT_NEAR(compare_images(a, b).ssim, direct_ssim(encoded_luminance(a), encoded_luminance(b)), 1e-9);
}

TEST(Compare, ImagesSmallerThanTheWindows) {
  for (const int size : {1, 2, 7}) {
    const ImageDifference d = compare_images(pattern(size, 1, true), pattern(size, 1, false));
    EXPECT_TRUE(std::isfinite(d.ssim) && d.ssim < 1) << size;
    EXPECT_TRUE(d.flip > 0 && d.flip <= 1) << size;
  }
}

TEST(Compare, FlipIsThatOfTheReferenceImplementation) {
  // Means of the authors' implementation, version 1.x in C++, at the same distance, for the same images.
  EXPECT_NEAR(compare_images(pattern(96, 64, true), pattern(96, 64, false)).flip, 0.35060313, 1e-5);
  EXPECT_NEAR(compare_images(pattern(13, 7, true), pattern(13, 7, false)).flip, 0.37669685, 1e-5);
}

TEST(Compare, FlipOfBlackAndWhite) {
  const double flip = compare_images(constant_image(30, 30, 1), constant_image(30, 30, 0)).flip;
  EXPECT_GT(flip, 0.9);
  EXPECT_LE(flip, 1);
}

TEST(Compare, DifferenceImageIsDarkWhereEqual) {
  const Image map = difference_image(pattern(96, 64, true), pattern(96, 64, false));
  ASSERT_EQ(map.channels, (std::vector<std::string>{"R", "G", "B"}));
  const Image none = difference_image(pattern(96, 64, false), pattern(96, 64, false));
  EXPECT_EQ(none.planes[0][0], 0);
  EXPECT_NEAR(none.planes[2][0], static_cast<float>(srgb_decode(4 / 255.0)), 1e-6f);
  EXPECT_GT(*std::max_element(map.planes[0].begin(), map.planes[0].end()), 0.8f);
}

TEST(Compare, ReferenceRenders) {
  const std::filesystem::path folder = ALHAZEN_SOURCE_DIR "/../shared/references/weekend";
  if (!std::filesystem::exists(folder / "half1.exr")) GTEST_SKIP() << "the reference renders are not here";
  const Image a = read_image((folder / "half1.exr").string()), b = read_image((folder / "half2.exr").string());
  const ImageDifference d = compare_images(a, b);
  EXPECT_NEAR(d.mse, 2.0e-4, 0.05e-4);
  // 0.399528 and 0.399535 are documented: they are means over the channels, not of the luminance.
  const auto channel_mean = [](const Image& image) {
    double sum = 0;
    for (const std::vector<float>& plane : image.planes)
      for (const float value : plane) sum += static_cast<double>(value);
    return sum / static_cast<double>(3 * image.planes[0].size());
  };
  EXPECT_NEAR(channel_mean(a), 0.399528, 1e-6);
  EXPECT_NEAR(channel_mean(b), 0.399535, 1e-6);
  EXPECT_NEAR(d.mean_a, d.mean_b, 1e-4);
  EXPECT_NEAR(d.flip, 0.0275, 1e-3);
}

}  // namespace
}  // namespace alhazen::impl::test

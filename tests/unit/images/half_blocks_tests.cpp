// An image as text for terminals.

#include "images/display/half_blocks.h"

#include <gtest/gtest.h>

#include <limits>

namespace alhazen::impl::test {

namespace {

Image image_of_columns(int width, int height) {
  const size_t pixels = static_cast<size_t>(width) * static_cast<size_t>(height);
  Image image{width, height, {"depth.Z", "B", "G", "R"}, std::vector(4, std::vector<float>(pixels))};
  for (size_t i = 0; i < pixels; ++i) {
    image.planes[0][i] = 100;
    image.planes[3][i] = static_cast<float>(i % static_cast<size_t>(width));
    image.planes[1][i] = 1;
  }
  return image;
}

TEST(HalfBlocks, AreOfMeansOverTheAreas) {
  const Image image = image_of_columns(9, 6);
  const ReducedImage reduced = reduce_image(source_of(image), 3, 100);
  EXPECT_EQ(reduced.width, 3);
  EXPECT_EQ(reduced.height, 2);
  for (size_t i = 0; i < 6; ++i) {
    EXPECT_FLOAT_EQ(reduced.rgb[3 * i], static_cast<float>(3 * (i % 3) + 1)) << "0 1 2, 3 4 5, 6 7 8";
    EXPECT_FLOAT_EQ(reduced.rgb[3 * i + 1], 0);
    EXPECT_FLOAT_EQ(reduced.rgb[3 * i + 2], 1);
  }
  // 5 columns become 2: each has two and a half.
  const ReducedImage halves = reduce_image(source_of(image_of_columns(5, 5)), 2, 2);
  ASSERT_EQ(halves.width, 2);
  EXPECT_FLOAT_EQ(halves.rgb[0], (0 + 1 + 2 * 0.5f) / 2.5f);
  EXPECT_FLOAT_EQ(halves.rgb[3], (2 * 0.5f + 3 + 4) / 2.5f);
}

TEST(HalfBlocks, KeepTheShapeAndAreNeverLarger) {
  const auto size = [](int width, int height, int max_width, int max_height) {
    const ReducedImage reduced = reduce_image(source_of(image_of_columns(width, height)), max_width, max_height);
    EXPECT_EQ(reduced.rgb.size(), 3 * static_cast<size_t>(reduced.width * reduced.height));
    return std::pair(reduced.width, reduced.height);
  };
  EXPECT_EQ(size(10, 4, 80, 48), std::pair(10, 4));
  EXPECT_EQ(size(160, 40, 80, 48), std::pair(80, 20));
  EXPECT_EQ(size(40, 160, 80, 48), std::pair(12, 48));
  EXPECT_EQ(size(1000, 1, 10, 10), std::pair(10, 1));
  EXPECT_EQ(size(1, 1000, 1, 1), std::pair(1, 1));
}

TEST(HalfBlocks, CountWhatIsNoNumberAsBlack) {
  Image image = image_of_columns(2, 1);
  image.planes[3] = {std::numeric_limits<float>::quiet_NaN(), 4};
  image.planes[1] = {std::numeric_limits<float>::infinity(), 2};
  const ReducedImage reduced = reduce_image(source_of(image), 1, 1);
  EXPECT_EQ(reduced.rgb, (std::vector<float>{2, 0, 1}));
}

TEST(HalfBlocks, AreCharactersOfTwoPixels) {
  const DisplayTransform display{WriteOptions{}};
  const ReducedImage image{2, 3, {1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}};
  const std::vector<std::string> lines = terminal_lines(image, display, true);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0], "\x1b[38;2;255;0;0m\x1b[48;2;0;255;0m\u2580\u2580\x1b[0m");
  EXPECT_EQ(lines[1], "\x1b[38;2;0;0;255m\u2580\x1b[38;2;255;255;255m\u2580\x1b[0m");
  const std::vector<std::string> blanks = terminal_lines(image, display, false);
  EXPECT_EQ(blanks[0], "\x1b[48;2;128;128;0m  \x1b[0m");
}

TEST(HalfBlocks, AreShownAsPngFilesAre) {
  WriteOptions options;
  options.exposure = 1;
  const ReducedImage image{1, 2, {0.25f, 0.25f, 0.25f, 0.25f, 0.25f, 0.25f}};
  const auto value = static_cast<int>(std::lround(255 * srgb_encode(0.5)));
  const std::string code =
      ";2;" + std::to_string(value) + ";" + std::to_string(value) + ";" + std::to_string(value) + "m";
  EXPECT_EQ(terminal_lines(image, DisplayTransform(options), true).at(0),
            "\x1b[38" + code + "\x1b[48" + code + "\u2580\x1b[0m");
}

}  // namespace

}  // namespace alhazen::impl::test

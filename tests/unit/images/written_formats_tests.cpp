// What PNG of 16 bits, JPEG and HDR keep of an image, and what is said in them about it.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "colour/white_point.h"
#include "image_files.h"
#include "images/image.h"

namespace alhazen::impl::test {

namespace {

Image image_of_rows(int width, int height, const std::vector<float>& red, const std::vector<float>& green,
                    const std::vector<float>& blue) {
  return {width, height, {"R", "G", "B"}, {red, green, blue}};
}

Image row_of_grey(const std::vector<float>& values) {
  return image_of_rows(static_cast<int>(values.size()), 1, values, values, values);
}

/// Colours that change slowly, as most of a picture does.
Image smooth_image(int width, int height) {
  std::array<std::vector<float>, 3> planes;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (size_t c = 0; c < 3; ++c)
        planes[c].push_back(
            0.5f + 0.4f * std::sin(0.05f * static_cast<float>(x + y * static_cast<int>(c)) + static_cast<float>(c)));
  return image_of_rows(width, height, planes[0], planes[1], planes[2]);
}

bool holds(const Bytes& bytes, const std::string& text) {
  return std::search(bytes.begin(), bytes.end(), text.begin(), text.end(), [](uint8_t byte, char character) {
           return byte == static_cast<uint8_t>(character);
         }) != bytes.end();
}

TEST(Png16, HoldsSixteenBits) {
  const TemporaryFolder folder;
  std::vector<float> values;
  for (int i = 0; i <= 3000; ++i) values.push_back(static_cast<float>(i) / 3000);
  write_png(folder.file("a.png"), source_of(row_of_grey(values)), {.png_depth = 16});
  const Image back = read_image(folder.file("a.png"));
  for (size_t i = 0; i < values.size(); ++i)
    // Half a step of the curve, which is steepest at white, and the rounding of floats.
    ASSERT_NEAR(back.planes[1][i], values[i], 0.5f / 65535 * 2.3f + 1e-7f) << i;
}

TEST(Png16, IsToneMappedAndBalancedAsTheOtherIs) {
  const TemporaryFolder folder;
  const Image image = smooth_image(20, 10);
  WriteOptions options{.exposure = 1.5, .white_temperature = 3200, .tone_map = ToneMap::agx};
  write_png(folder.file("8.png"), source_of(image), options);
  options.png_depth = 16;
  write_png(folder.file("16.png"), source_of(image), options);
  const Image eight = read_image(folder.file("8.png")), sixteen = read_image(folder.file("16.png"));
  for (size_t c = 0; c < 3; ++c)
    for (size_t i = 0; i < 200; ++i)
      ASSERT_NEAR(srgb_encode(static_cast<double>(eight.planes[c][i])),
                  srgb_encode(static_cast<double>(sixteen.planes[c][i])), 0.51 / 255);
  EXPECT_NE(eight.planes[0], sixteen.planes[0]);
}

TEST(Png, NeutralStaysNeutralAtD65AndLampLightBecomesNeutral) {
  const TemporaryFolder folder;
  const Image grey = row_of_grey({0.01f, 0.18f, 0.5f, 1});
  write_png(folder.file("off.png"), source_of(grey), {});
  write_png(folder.file("d65.png"), source_of(grey), {.white_temperature = d65_temperature});
  EXPECT_EQ(read_image(folder.file("off.png")).planes, read_image(folder.file("d65.png")).planes);
  write_png(folder.file("warm.png"), source_of(grey), {.white_temperature = 3000});
  const Image warm = read_image(folder.file("warm.png"));
  EXPECT_LT(warm.planes[0][1], warm.planes[1][1]);
  EXPECT_GT(warm.planes[2][1], warm.planes[1][1]);
  // The same image, not balanced, where balance is not for the format.
  write_pfm(folder.file("a.pfm"), source_of(grey), {.white_temperature = 3000});
  EXPECT_EQ(read_image(folder.file("a.pfm")).planes, grey.planes);
}

TEST(Png, SaysItsColoursAndHowItWasMade) {
  const TemporaryFolder folder;
  WriteOptions options;
  options.metadata = {{"software", "Alhazen 1"}, {"scene", "a\xff\n b\xc3\xa9"}, {"seconds", "1.5"}};
  write_png(folder.file("a.png"), source_of(row_of_grey({0.5f})), options);
  const Bytes bytes = read_file(folder.file("a.png"));
  for (const char* chunk : {"sRGB", "gAMA", "cHRM", "iTXt"}) EXPECT_TRUE(holds(bytes, chunk)) << chunk;
  EXPECT_TRUE(holds(bytes, std::string("Software\0\0\0\0\0Alhazen 1", 22)));
  EXPECT_TRUE(holds(bytes, "b\xc3\xa9")) << "UTF-8";
  EXPECT_FALSE(holds(bytes, "\xff\n"));
  EXPECT_FALSE(holds(bytes, "seconds")) << "equal images are equal files";
}

TEST(Jpeg, LosesLittle) {
  const TemporaryFolder folder;
  const Image image = smooth_image(61, 37);
  const auto largest_error = [&](int quality) {
    write_jpg(folder.file("a.jpg"), source_of(image), {.jpeg_quality = quality});
    const Image back = read_image(folder.file("a.jpg"));
    EXPECT_EQ(back.width, 61);
    EXPECT_EQ(back.height, 37);
    double largest = 0;
    for (size_t c = 0; c < 3; ++c)
      for (size_t i = 0; i < image.planes[c].size(); ++i)
        largest = std::max(largest, std::abs(srgb_encode(static_cast<double>(back.planes[c][i])) -
                                             srgb_encode(static_cast<double>(image.planes[c][i]))));
    return largest;
  };
  EXPECT_LT(largest_error(100), 4.0 / 255);
  EXPECT_LT(largest_error(95), 6.0 / 255);
  const size_t fine = read_file(folder.file("a.jpg")).size();
  EXPECT_GT(largest_error(5), 10.0 / 255);
  EXPECT_LT(read_file(folder.file("a.jpg")).size(), fine);
}

TEST(Jpeg, KeepsTheColoursOfEdges) {
  const TemporaryFolder folder;
  // Columns of red and blue: with chroma of half the resolution they would be purple.
  std::vector<float> red, blue;
  for (int i = 0; i < 32 * 32; ++i) {
    red.push_back(i % 2 == 0 ? 1.0f : 0.0f);
    blue.push_back(i % 2 == 0 ? 0.0f : 1.0f);
  }
  const Image image = image_of_rows(32, 32, red, std::vector<float>(red.size()), blue);
  write_jpg(folder.file("a.jpg"), source_of(image), {});
  const Image back = read_image(folder.file("a.jpg"));
  for (size_t i = 0; i < red.size(); ++i) ASSERT_NEAR(back.planes[0][i], red[i], 0.1f) << i;
}

TEST(Jpeg, SaysHowItWasMade) {
  const TemporaryFolder folder;
  WriteOptions options;
  options.metadata = {{"settings", "--spp 4"}, {"seconds", "1.5"}, {"long", std::string(100000, 'x')}};
  write_jpg(folder.file("a.jpg"), source_of(row_of_grey({0.5f})), options);
  const Bytes bytes = read_file(folder.file("a.jpg"));
  EXPECT_EQ(bytes[0], 0xff);
  EXPECT_TRUE(holds(bytes, "JFIF"));
  EXPECT_FALSE(holds(bytes, "1.5"));
  EXPECT_TRUE(holds(bytes, "xxx"));
  EXPECT_EQ(read_image(folder.file("a.jpg")).width, 1) << "a comment ends where the format says";
}

TEST(Jpeg, OfTooManyPixelsIsRefused) {
  const TemporaryFolder folder;
  const ImageSource wide{max_jpeg_side + 1, 1, {"R", "G", "B"}, [](int, std::span<float>) {}};
  try {
    write_jpg(folder.file("a.jpg"), wide, {});
    FAIL();
  } catch (const RenderError& error) {
    EXPECT_NE(std::string(error.what()).find("at most 65500 pixels"), std::string::npos) << error.what();
  }
  EXPECT_EQ(folder.count(), 0u);
}

TEST(Hdr, HoldsEightBitsOfEachValue) {
  const TemporaryFolder folder;
  for (const int width : {3, 8, 300}) {
    std::array<std::vector<float>, 3> planes;
    for (int i = 0; i < 4 * width; ++i)
      for (size_t c = 0; c < 3; ++c)
        // Runs and steps over thirty decades.
        planes[c].push_back(std::pow(10.0f, static_cast<float>(i / 7 % 30 - 15)) *
                            (1 + 0.1f * static_cast<float>(c * c)));
    const Image image = image_of_rows(width, 4, planes[0], planes[1], planes[2]);
    write_hdr(folder.file("a.hdr"), source_of(image), {.exposure = 3, .white_temperature = 3000});
    const Image back = read_image(folder.file("a.hdr"));
    ASSERT_EQ(back.width, width);
    ASSERT_EQ(back.height, 4);
    for (size_t i = 0; i < planes[0].size(); ++i)
      for (size_t c = 0; c < 3; ++c)
        ASSERT_NEAR(back.planes[c][i] / image.planes[2][i], image.planes[c][i] / image.planes[2][i], 0.5001f / 128)
            << i;
  }
}

TEST(Hdr, OfOddValues) {
  const TemporaryFolder folder;
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<float> values{0,       -1, std::nanf(""), infinity, -infinity, 3e38f, 1e-38f, 1e-45f,
                                  0.9999f, 1,  255.9f,        256,      0.5f,      2};
  write_hdr(folder.file("a.hdr"), source_of(row_of_grey(values)), {});
  const std::vector<float> back = read_image(folder.file("a.hdr")).planes[0];
  for (const size_t i : {0, 1, 2, 4, 7}) EXPECT_EQ(back[i], 0) << i;
  EXPECT_EQ(back[3], 0x1.fep126f) << "the largest that the format has";
  EXPECT_EQ(back[5], 0x1.fep126f);
  EXPECT_NEAR(back[6] / 1e-38f, 1, 0.01f);
  for (const size_t i : {8, 9, 10, 11, 12, 13}) EXPECT_NEAR(back[i] / values[i], 1, 0.5f / 128) << values[i];
}

TEST(Hdr, HasTheHeaderOfTheFormat) {
  const TemporaryFolder folder;
  WriteOptions options;
  options.metadata = {{"software", "Alhazen 1"}};
  write_hdr(folder.file("a.hdr"), source_of(row_of_grey(std::vector<float>(8, 1.0f))), options);
  const Bytes expected = text(
                             "#?RADIANCE\nSOFTWARE=Alhazen 1\nFORMAT=32-bit_rle_rgbe\n"
                             "PRIMARIES=0.6400 0.3300 0.3000 0.6000 0.1500 0.0600 0.3127 0.3290\n\n-Y 1 +X 8\n") +
                         Bytes{2, 2, 0, 8, 136, 128, 136, 128, 136, 128, 136, 129};
  EXPECT_EQ(read_file(folder.file("a.hdr")), expected);
}

}  // namespace

}  // namespace alhazen::impl::test

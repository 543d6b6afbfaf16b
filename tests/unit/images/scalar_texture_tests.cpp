// Images as scalar textures: their alpha, in every format that supports it, unless it is 1 everywhere; else their
// colours.

#include "images/read_scalar_texture.h"

#include <gtest/gtest.h>

#include "image_files.h"
#include "images/image.h"
#include "unit/io/pbrt_support.h"

namespace alhazen::impl::test {
namespace {

ScalarTexture read(const std::string& name, const Bytes& bytes, TextureEncoding encoding = TextureEncoding::automatic) {
  const TemporaryFolder folder;
  return read_scalar_texture(folder.write(name, bytes), encoding);
}

/// The alpha as bytes; {} if the colours were used.
Bytes alpha_of(const std::string& name, const Bytes& bytes) {
  for (const TextureEncoding encoding : {TextureEncoding::automatic, TextureEncoding::srgb, TextureEncoding::linear}) {
    const ScalarTexture scalar = read(name, bytes, encoding);
    if (!scalar.from_alpha) return {};
    EXPECT_EQ(scalar.texels.channels, 1) << name;
    EXPECT_FALSE(scalar.texels.srgb) << name << ": alpha is linear";
    if (encoding == TextureEncoding::linear) return scalar.texels.bytes;
  }
  return {};
}

Bytes bmp_of_version_5(const Bytes& rows, uint32_t compression, const std::array<uint32_t, 4>& masks, int width) {
  Bytes header = little_32(124) + little_32(static_cast<uint32_t>(width)) + little_32(1) + little_16(1) +
                 little_16(32) + little_32(compression) + Bytes(20, 0);
  for (const uint32_t mask : masks) header = header + little_32(mask);
  header.resize(124);
  return text("BM") + little_32(0) + little_32(0) + little_32(138) + header + rows;
}

Bytes qoi(uint8_t channels, uint8_t colour_space, const Bytes& chunks, uint32_t width) {
  return text("qoif") + big_32(width) + big_32(1) + Bytes{channels, colour_space} + chunks +
         Bytes{0, 0, 0, 0, 0, 0, 0, 1};
}

TEST(ScalarTexture, AlphaOfPng) {
  EXPECT_EQ(alpha_of("rgba.png", png(2, 1, 8, 6, {0, 9, 9, 9, 0, 9, 9, 9, 51})), Bytes({0, 51}));
  EXPECT_EQ(alpha_of("grey.png", png(2, 1, 8, 4, {0, 9, 7, 9, 255})), Bytes({7, 255}));
  const Bytes palette = png_chunk("PLTE", {10, 20, 30, 40, 50, 60}) + png_chunk("tRNS", {128});
  EXPECT_EQ(alpha_of("palette.png", png(2, 1, 8, 3, {0, 1, 0}, palette)), Bytes({255, 128}));
  EXPECT_EQ(alpha_of("bits.png", png(2, 1, 1, 3, {0, 0x40}, palette)), Bytes({128, 255}));
  EXPECT_EQ(alpha_of("key.png", png(2, 1, 8, 2, {0, 1, 2, 3, 1, 2, 4}, png_chunk("tRNS", {0, 1, 0, 2, 0, 3}))),
            Bytes({0, 255}));
  EXPECT_EQ(alpha_of("grey-key.png", png(2, 1, 8, 0, {0, 5, 6}, png_chunk("tRNS", {0, 6}))), Bytes({255, 0}));
}

TEST(ScalarTexture, AlphaOfPngOf16BitsKeepsThem) {
  const ScalarTexture rgba =
      read("rgba.png", png(2, 1, 16, 6, {0, 1, 1, 1, 1, 1, 1, 0x12, 0x34, 0, 0, 0, 0, 0, 0, 0, 1}));
  ASSERT_TRUE(rgba.from_alpha);
  EXPECT_FALSE(rgba.differs_from_pbrt);
  EXPECT_EQ(rgba.texels.floats, (std::vector<float>{0x1234 / 65535.0f, 1 / 65535.0f}));
  const ScalarTexture grey = read("grey.png", png(1, 1, 16, 4, {0, 1, 1, 0x80, 0}));
  EXPECT_EQ(grey.texels.floats, (std::vector<float>{0x8000 / 65535.0f}));
}

TEST(ScalarTexture, AlphaOfTga) {
  const Bytes two{1, 2, 3, 0, 1, 2, 3, 100};
  EXPECT_EQ(alpha_of("a.tga", tga(2, 2, 1, 32, 0x28, two)), Bytes({0, 100}));
  EXPECT_EQ(alpha_of("undeclared.tga", tga(2, 2, 1, 32, 0x20, two)), Bytes({0, 100}));
  EXPECT_EQ(alpha_of("up.tga", tga(2, 1, 2, 32, 0x08, two)), Bytes({100, 0}));
  EXPECT_EQ(alpha_of("runs.tga", tga(10, 3, 1, 32, 0x28, {0x82, 1, 2, 3, 4})), Bytes({4, 4, 4}));
  EXPECT_EQ(alpha_of("grey.tga", tga(3, 2, 1, 16, 0x28, {9, 3, 9, 4})), Bytes({3, 4}));
  EXPECT_EQ(alpha_of("bit.tga", tga(2, 2, 1, 16, 0x21, {1, 0x80, 1, 0})), Bytes({255, 0}));
  EXPECT_EQ(alpha_of("palette.tga", tga(1, 2, 1, 8, 0x28, {1, 0}, {0, 0, 2, 0, 32}, two)), Bytes({100, 0}));
  EXPECT_EQ(alpha_of("all.tga", tga(2, 1, 1, 32, 0x28, {1, 2, 3, 0})), Bytes({0})) << "declared, and 0 everywhere";
}

TEST(ScalarTexture, TgaWithoutAlpha) {
  EXPECT_EQ(alpha_of("unused.tga", tga(2, 2, 1, 32, 0x20, {1, 2, 3, 0, 4, 5, 6, 0})), Bytes{});
  EXPECT_EQ(alpha_of("opaque.tga", tga(2, 1, 1, 32, 0x28, {1, 2, 3, 255})), Bytes{});
  EXPECT_EQ(alpha_of("colour.tga", tga(2, 1, 1, 24, 0x28, {1, 2, 3})), Bytes{});
  EXPECT_EQ(alpha_of("bit.tga", tga(2, 2, 1, 16, 0x20, {1, 0x80, 1, 0})), Bytes{});
}

TEST(ScalarTexture, AlphaOfBmp) {
  const Bytes two{1, 2, 3, 0, 1, 2, 3, 100};
  const std::array<uint32_t, 4> masks{0xff0000, 0x00ff00, 0x0000ff, 0xff000000};
  EXPECT_EQ(alpha_of("v5.bmp", bmp_of_version_5(two, 3, masks, 2)), Bytes({0, 100}));
  EXPECT_EQ(alpha_of("v5-plain.bmp", bmp_of_version_5(two, 0, masks, 2)), Bytes({0, 100}));
  EXPECT_EQ(alpha_of("first.bmp", bmp_of_version_5(two, 3, {0xff000000, 0xff0000, 0xff00, 0xff}, 2)), Bytes({1, 1}));
  EXPECT_EQ(alpha_of("plain.bmp", bmp(2, 1, 32, 0, {}, two)), Bytes({0, 100}));
  EXPECT_EQ(alpha_of("down.bmp", bmp(1, -2, 32, 0, {}, two)), Bytes({0, 100}));
  EXPECT_EQ(alpha_of("up.bmp", bmp(1, 2, 32, 0, {}, two)), Bytes({100, 0}));
  const Bytes nibbles = little_32(0x0f00) + little_32(0x00f0) + little_32(0x000f) + little_32(0xf000);
  EXPECT_EQ(alpha_of("nibbles.bmp", bmp(2, 1, 16, 6, nibbles, {0, 0x50, 0, 0xf0})), Bytes({85, 255}));
}

TEST(ScalarTexture, BmpWithoutAlpha) {
  EXPECT_EQ(alpha_of("unused.bmp", bmp(1, 1, 32, 0, {}, {1, 2, 3, 0})), Bytes{});
  EXPECT_EQ(alpha_of("colour.bmp", bmp(1, 1, 24, 0, {}, {1, 2, 3, 0})), Bytes{});
  const Bytes masks = little_32(0xff0000) + little_32(0xff00) + little_32(0xff);
  EXPECT_EQ(alpha_of("masks.bmp", bmp(1, 1, 32, 3, masks, {1, 2, 3, 9})), Bytes{});
}

TEST(ScalarTexture, AlphaOfQoi) {
  // (9, 9, 9, 7), then green one more, red and blue two more, then that again, then the first again, then a run of two.
  const Bytes chunks{0xff, 9, 9, 9, 7, 0x80 | 33, 0x99, 0xc0, static_cast<uint8_t>((9 * 15 + 7 * 11) % 64), 0xc1};
  EXPECT_EQ(alpha_of("a.qoi", qoi(4, 0, chunks, 6)), Bytes(6, 7));
  EXPECT_EQ(alpha_of("b.qoi", qoi(4, 0, {0xff, 9, 9, 9, 255}, 1)), Bytes{});
  const TemporaryFolder folder;
  const ImageTexels colours = read_texture(folder.write("a.qoi", qoi(4, 0, chunks, 6)), TextureEncoding::automatic);
  EXPECT_EQ(colours.bytes, Bytes({9, 9, 9, 11, 10, 11, 11, 10, 11, 9, 9, 9, 9, 9, 9, 9, 9, 9}));
  EXPECT_TRUE(colours.srgb);
  // (0, 0, 0) less (1, 2, 2) is (255, 254, 254).
  const ImageTexels linear = read_texture(folder.write("b.qoi", qoi(3, 1, {0x50}, 1)), TextureEncoding::automatic);
  EXPECT_EQ(linear.bytes, Bytes({255, 254, 254}));
  EXPECT_FALSE(linear.srgb) << "the file says so";
}

#ifdef ALHAZEN_WITH_WEBP
TEST(ScalarTexture, AlphaOfWebp) {
  const Bytes file{0x52, 0x49, 0x46, 0x46, 0x20, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42, 0x50, 0x56, 0x50,
                   0x38, 0x4c, 0x13, 0x00, 0x00, 0x00, 0x2f, 0x00, 0x40, 0x00, 0x10, 0x0f, 0x30, 0xff,
                   0xf3, 0x3f, 0xff, 0xf3, 0x1f, 0xf0, 0x98, 0x80, 0x88, 0xfe, 0x47, 0x00};
  EXPECT_EQ(alpha_of("a.webp", file), Bytes({255, 0}));
}
#endif

ScalarTexture read_exr_of(const std::vector<std::string>& channels, const std::vector<float>& values) {
  const TemporaryFolder folder;
  Image image{1, 1, channels, {}};
  for (const float value : values) image.planes.push_back({value});
  write_exr(folder.file("a.exr"), source_of(image), {});
  return read_scalar_texture(folder.file("a.exr"), TextureEncoding::automatic);
}

TEST(ScalarTexture, AlphaOfExr) {
  EXPECT_EQ(read_exr_of({"R", "G", "B", "A"}, {1, 2, 3, 0.25f}).texels.floats, (std::vector<float>{0.25f}));
  EXPECT_EQ(read_exr_of({"R", "G", "B", "A", "Z"}, {1, 2, 3, 0, 5}).texels.floats, (std::vector<float>{0}));
  EXPECT_EQ(read_exr_of({"Y", "A"}, {1, 0.5f}).texels.floats, (std::vector<float>{0.5f}));
  EXPECT_EQ(read_exr_of({"l.R", "l.G", "l.B", "l.A"}, {1, 2, 3, 0.5f}).texels.floats, (std::vector<float>{0.5f}));
  EXPECT_EQ(read_exr_of({"R", "G", "B", "A"}, {1, 2, 3, 1}).texels.floats, (std::vector<float>{2}));
  EXPECT_EQ(read_exr_of({"R", "G", "B", "l.A"}, {1, 2, 3, 0}).texels.floats, (std::vector<float>{2}))
      << "the alpha of another layer";
}

TEST(ScalarTexture, MeanOfTheColoursWhereAlphaIsOne) {
  const ScalarTexture mask = read("mask.png", png(2, 1, 8, 6, {0, 9, 9, 9, 255, 0, 0, 255, 255}));
  EXPECT_FALSE(mask.from_alpha);
  ASSERT_EQ(mask.texels.channels, 1);
  EXPECT_NEAR(static_cast<double>(mask.texels.floats[0]), srgb_decode(9 / 255.0), 1e-7);
  EXPECT_NEAR(static_cast<double>(mask.texels.floats[1]), 1 / 3.0, 1e-7);
  EXPECT_FALSE(read("a.png", png(1, 1, 8, 2, {0, 1, 2, 3})).from_alpha);
  EXPECT_FALSE(read("a.jpg", jpeg(3)).from_alpha);
  EXPECT_FALSE(read("a.hdr", hdr(1, 1, {128, 64, 0, 129})).from_alpha);
  EXPECT_FALSE(read("a.pfm", pfm("PF", 1, 1, "-1.0", floats({1, 2, 3}))).from_alpha);
}

/// Every use as a float texture takes the alpha, and a spectrum texture of the same file its colours.
TEST(ScalarTexture, OfPbrtScenes) {
  const TemporaryFolder folder;
  folder.write("leaf.png", png(2, 1, 8, 6, {0, 200, 100, 50, 0, 200, 100, 50, 255}));
  folder.write("leaf.tga", tga(2, 2, 1, 32, 0x28, {1, 2, 3, 0, 1, 2, 3, 100}));
  const auto parsed = test::parse_world(
      "Texture \"leaf\" \"float\" \"imagemap\" \"string filename\" \"leaf.png\" \"string filter\" \"point\"\n"
      "Texture \"leaf\" \"spectrum\" \"imagemap\" \"string filename\" \"leaf.png\"\n"
      "Texture \"twice\" \"float\" \"scale\" \"texture tex\" \"leaf\" \"float scale\" 2\n"
      "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"texture reflectance\" \"leaf\"\n"
      "MakeNamedMaterial \"b\" \"string type\" \"dielectric\" \"texture roughness\" \"leaf\"\n"
      "MakeNamedMaterial \"m\" \"string type\" \"mix\" \"string materials\" [ \"a\" \"b\" ] \"texture amount\" "
      "\"leaf\"\n"
      "NamedMaterial \"m\" Shape \"sphere\" \"texture alpha\" \"twice\"\n"
      "Texture \"other\" \"float\" \"imagemap\" \"string filename\" \"leaf.tga\"\n",
      folder.path());
  ASSERT_EQ(parsed.scene.images.size(), 3u);
  EXPECT_EQ(parsed.scene.images[0].bytes, Bytes({0, 255}));
  EXPECT_EQ(parsed.scene.images[1].channels, 3);
  EXPECT_EQ(parsed.scene.images[1].bytes, Bytes({200, 100, 50, 200, 100, 50}));
  EXPECT_EQ(parsed.scene.images[2].bytes, Bytes({0, 100}));
  EXPECT_FALSE(parsed.warned("leaf.png")) << "as pbrt-v4 has it";
  EXPECT_TRUE(parsed.warned("test.pbrt:9:")) << "pbrt-v4 reads no alpha of TGA";
  EXPECT_TRUE(parsed.warned("the alpha channel of \"leaf.tga\""));
}

}  // namespace
}  // namespace alhazen::impl::test

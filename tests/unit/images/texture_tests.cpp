// Image files as colour textures: formats, pixel types, orientations, and damaged files.

#include "images/read_texture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "image_files.h"
#include "images/image.h"
#include "images/read_scalar_texture.h"

namespace alhazen::impl::test {
namespace {

ImageTexels read(const std::string& name, const Bytes& bytes, TextureEncoding encoding = TextureEncoding::automatic) {
  const TemporaryFolder folder;
  return read_texture(folder.write(name, bytes), encoding);
}

/// The message of the InputError, without the path, or "" if nothing was thrown.
std::string error_of(const std::string& name, const Bytes& bytes) {
  const TemporaryFolder folder;
  const std::string path = folder.write(name, bytes);
  try {
    read_texture(path, TextureEncoding::automatic);
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_TRUE(message.starts_with(path + ": ")) << message;
    return message.substr(std::min(message.size(), path.size() + 2));
  }
  return "";
}

const Bytes red_green_blue_white{255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};

TEST(Texture, PngKeepsBytesAndMarksThemSrgb) {
  const ImageTexels texels = read("a.png", png(2, 2, 8, 2, {0, 255, 0, 0, 0, 255, 0, 0, 0, 0, 255, 255, 255, 255}));
  EXPECT_EQ(texels.width, 2);
  EXPECT_EQ(texels.height, 2);
  EXPECT_TRUE(texels.srgb);
  EXPECT_TRUE(texels.floats.empty());
  EXPECT_EQ(texels.bytes, red_green_blue_white);
  EXPECT_TRUE(texels.name.ends_with("a.png"));
}

TEST(Texture, LinearEncodingIsKept) {
  const ImageTexels texels = read("a.png", png(1, 1, 8, 0, {0, 100}), TextureEncoding::linear);
  EXPECT_FALSE(texels.srgb);
  EXPECT_EQ(texels.bytes, Bytes({100, 100, 100}));
}

TEST(Texture, PngOfEveryColourType) {
  EXPECT_EQ(read("grey.png", png(2, 1, 8, 0, {0, 7, 200})).bytes, Bytes({7, 7, 7, 200, 200, 200}));
  EXPECT_EQ(read("bits.png", png(3, 1, 1, 0, {0, 0b10100000})).bytes, Bytes({255, 255, 255, 0, 0, 0, 255, 255, 255}));
  EXPECT_EQ(read("grey-alpha.png", png(1, 1, 8, 4, {0, 9, 0})).bytes, Bytes({9, 9, 9}));
  EXPECT_EQ(read("rgba.png", png(1, 1, 8, 6, {0, 1, 2, 3, 0})).bytes, Bytes({1, 2, 3}));
  const Bytes palette = png_chunk("PLTE", {10, 20, 30, 40, 50, 60});
  EXPECT_EQ(read("palette.png", png(2, 1, 8, 3, {0, 1, 0}, palette)).bytes, Bytes({40, 50, 60, 10, 20, 30}));
  const Bytes transparent = palette + png_chunk("tRNS", {0, 128});
  EXPECT_EQ(read("transparent.png", png(2, 1, 4, 3, {0, 0x10}, transparent)).bytes, Bytes({40, 50, 60, 10, 20, 30}));
}

TEST(Texture, PngIgnoresItsGamma) {
  const Bytes gamma = png_chunk("gAMA", big_32(100000));
  EXPECT_EQ(read("gamma.png", png(1, 1, 8, 0, {0, 100}, gamma)).bytes, Bytes({100, 100, 100}));
}

TEST(Texture, PngOf16BitsIsDecoded) {
  const Bytes file = png(1, 1, 16, 2, {0, 0x80, 0x00, 0xff, 0xff, 0x00, 0x00});
  const ImageTexels texels = read("deep.png", file);
  EXPECT_TRUE(texels.bytes.empty());
  EXPECT_FALSE(texels.srgb);
  ASSERT_EQ(texels.floats.size(), 3u);
  EXPECT_NEAR(static_cast<double>(texels.floats[0]), srgb_decode(32768 / 65535.0), 1e-7);
  EXPECT_EQ(texels.floats[1], 1.0f);
  EXPECT_EQ(texels.floats[2], 0.0f);
  EXPECT_NEAR(static_cast<double>(read("deep.png", file, TextureEncoding::linear).floats[0]), 32768 / 65535.0, 1e-7);
}

TEST(Texture, JpegGreyAndColour) {
  const ImageTexels grey = read("grey.jpg", jpeg(1));
  ASSERT_EQ(grey.bytes, Bytes(8 * 8 * 3, 168));
  EXPECT_TRUE(grey.srgb);
  // JFIF: R = Y + 1.402 (Cr - 128), G = Y - 0.344136 (Cb - 128) - 0.714136 (Cr - 128), B = Y + 1.772 (Cb - 128).
  const ImageTexels colour = read("colour.jpeg", jpeg(3));
  ASSERT_EQ(colour.bytes.size(), 192u);
  EXPECT_NEAR(colour.bytes[0], 168 - 1.402 * 40, 1.5);
  EXPECT_NEAR(colour.bytes[1], 168 - 0.344136 * 40 + 0.714136 * 40, 1.5);
  EXPECT_NEAR(colour.bytes[2], 168 + 1.772 * 40, 1.5);
}

TEST(Texture, TgaColoursAndOrders) {
  const Bytes blue_first{0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255};
  EXPECT_EQ(read("down.tga", tga(2, 2, 2, 24, 0x20, blue_first)).bytes, red_green_blue_white);
  EXPECT_EQ(read("up.tga", tga(2, 2, 2, 24, 0, blue_first)).bytes,
            Bytes({0, 0, 255, 255, 255, 255, 255, 0, 0, 0, 255, 0}));
  EXPECT_EQ(read("left.tga", tga(2, 2, 2, 24, 0x30, blue_first)).bytes,
            Bytes({0, 255, 0, 255, 0, 0, 255, 255, 255, 0, 0, 255}));
  EXPECT_EQ(read("alpha.TGA", tga(2, 1, 1, 32, 0x28, {1, 2, 3, 0})).bytes, Bytes({3, 2, 1}));
  EXPECT_EQ(read("grey.tga", tga(3, 2, 1, 8, 0x20, {5, 6})).bytes, Bytes({5, 5, 5, 6, 6, 6}));
  EXPECT_EQ(read("five.tga", tga(2, 1, 1, 16, 0x20, little_16(31 << 10 | 16 << 5))).bytes, Bytes({255, 132, 0}));
}

TEST(Texture, TgaRunLengthsGoOnOverRows) {
  // Three times (30, 20, 10), then one literal, in rows of two.
  const Bytes packets{0x82, 10, 20, 30, 0x00, 1, 2, 3};
  EXPECT_EQ(read("runs.tga", tga(10, 2, 2, 24, 0x20, packets)).bytes,
            Bytes({30, 20, 10, 30, 20, 10, 30, 20, 10, 3, 2, 1}));
}

TEST(Texture, TgaPalette) {
  // Two entries of 24 bits, numbered from 5.
  const Bytes fields{5, 0, 2, 0, 24}, palette{1, 2, 3, 4, 5, 6};
  EXPECT_EQ(read("p.tga", tga(1, 2, 1, 8, 0x20, {6, 5}, fields, palette)).bytes, Bytes({6, 5, 4, 3, 2, 1}));
  EXPECT_NE(error_of("p.tga", tga(1, 2, 1, 8, 0x20, {6, 7}, fields, palette)), "");
}

TEST(Texture, BmpOfEveryDepth) {
  const Bytes rows_24{255, 0, 0, 255, 255, 255, 0, 0, 0, 0, 255, 0, 255, 0, 0, 0};
  EXPECT_EQ(read("a.bmp", bmp(2, 2, 24, 0, {}, rows_24)).bytes, red_green_blue_white);
  EXPECT_EQ(read("down.bmp", bmp(1, -2, 24, 0, {}, {1, 2, 3, 0, 4, 5, 6, 0})).bytes, Bytes({3, 2, 1, 6, 5, 4}));
  EXPECT_EQ(read("b.bmp", bmp(1, 1, 32, 0, {}, {1, 2, 3, 0})).bytes, Bytes({3, 2, 1}));
  EXPECT_EQ(read("c.bmp", bmp(1, 1, 16, 0, {}, little_16(31 << 10) + Bytes{0, 0})).bytes, Bytes({255, 0, 0}));
  const Bytes masks = little_32(0xf800) + little_32(0x07e0) + little_32(0x001f);
  EXPECT_EQ(read("d.bmp", bmp(1, 1, 16, 3, masks, little_16(63 << 5) + Bytes{0, 0})).bytes, Bytes({0, 255, 0}));
  const Bytes palette{1, 2, 3, 0, 4, 5, 6, 0};
  EXPECT_EQ(read("e.bmp", bmp(2, 1, 8, 0, palette, {1, 0, 0, 0}, 2)).bytes, Bytes({6, 5, 4, 3, 2, 1}));
  EXPECT_EQ(read("f.bmp", bmp(2, 1, 4, 0, palette, {0x10, 0, 0, 0}, 2)).bytes, Bytes({6, 5, 4, 3, 2, 1}));
  EXPECT_EQ(read("g.bmp", bmp(2, 1, 1, 0, palette, {0x80, 0, 0, 0}, 2)).bytes, Bytes({6, 5, 4, 3, 2, 1}));
  EXPECT_NE(error_of("h.bmp", bmp(2, 1, 8, 0, palette, {2, 0, 0, 0}, 2)), "");
}

TEST(Texture, BmpWithTheOldestHeader) {
  const Bytes file = text("BM") + little_32(0) + little_32(0) + little_32(32) + little_32(12) + little_16(1) +
                     little_16(1) + little_16(1) + little_16(1) + Bytes{9, 8, 7, 6, 5, 4} + Bytes{0x80, 0, 0, 0};
  EXPECT_EQ(read("old.bmp", file).bytes, Bytes({4, 5, 6}));
}

TEST(Texture, HdrFlatAndRunLengths) {
  // (128, 64, 0) at the exponent 129 is (1, 0.5, 0).
  const std::vector<float> expected{1, 0.5f, 0, 0, 0, 0};
  EXPECT_EQ(read("flat.hdr", hdr(2, 1, {128, 64, 0, 129, 9, 9, 9, 0})).floats, expected);
  const ImageTexels old = read("old.hdr", hdr(4, 1, {128, 64, 0, 129, 1, 1, 1, 3}));
  ASSERT_EQ(old.floats.size(), 12u);
  EXPECT_EQ(old.floats[9], 1.0f);
  const Bytes run{2, 2, 0, 8, 136, 128, 136, 64, 136, 0, 4, 129, 129, 129, 129, 132, 130};
  const ImageTexels texels = read("new.hdr", hdr(8, 1, run));
  ASSERT_EQ(texels.floats.size(), 24u);
  EXPECT_FALSE(texels.srgb);
  EXPECT_EQ(texels.floats[0], 1.0f);
  EXPECT_EQ(texels.floats[21], 2.0f);
  EXPECT_EQ(texels.floats[22], 1.0f);
}

/// The image of two rows of three texels, 1 2 3 above 4 5 6, in each of the eight possible orders of a file.
TEST(Texture, HdrOfEveryOrientation) {
  const std::pair<const char*, std::vector<int>> orders[] = {
      {"-Y 2 +X 3", {1, 2, 3, 4, 5, 6}}, {"-Y 2 -X 3", {3, 2, 1, 6, 5, 4}}, {"+Y 2 +X 3", {4, 5, 6, 1, 2, 3}},
      {"+Y 2 -X 3", {6, 5, 4, 3, 2, 1}}, {"+X 3 -Y 2", {1, 4, 2, 5, 3, 6}}, {"-X 3 -Y 2", {3, 6, 2, 5, 1, 4}},
      {"+X 3 +Y 2", {4, 1, 5, 2, 6, 3}}, {"-X 3 +Y 2", {6, 3, 5, 2, 4, 1}}};
  for (const auto& [size, values] : orders) {
    Bytes texels;
    for (const int value : values) texels = texels + Bytes{static_cast<uint8_t>(value), 0, 0, 136};
    const ImageTexels image =
        read("a.hdr", text("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + std::string(size) + "\n") + texels);
    EXPECT_EQ(image.width, 3) << size;
    EXPECT_EQ(image.height, 2) << size;
    for (size_t i = 0; i < 6; ++i) EXPECT_EQ(image.floats.at(3 * i), static_cast<float>(i + 1)) << size;
  }
  // Run lengths along columns: 8 texels of 1 in the left column, of 2 in the right one.
  const Bytes left{2, 2, 0, 8, 136, 128, 136, 0, 136, 0, 136, 129},
      right{2, 2, 0, 8, 136, 128, 136, 0, 136, 0, 136, 130};
  const ImageTexels image = read("b.hdr", text("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-X 2 -Y 8\n") + right + left);
  EXPECT_EQ(image.width, 2);
  EXPECT_EQ(image.height, 8);
  EXPECT_EQ(image.floats[0], 1.0f);
  EXPECT_EQ(image.floats[3], 2.0f);
  for (const char* size : {"-Y 2 +Y 3", "-Y 2", "Y 2 X 3", "-Y two +X 3", "-Z 2 +X 3"})
    EXPECT_NE(error_of("c.hdr", text("#?RADIANCE\n\n" + std::string(size) + "\n")).find("size"), std::string::npos);
}

TEST(Texture, PfmOfBothKindsAndByteOrders) {
  const std::vector<float> expected{4, 5, 6, 1, 2, 3};
  EXPECT_EQ(read("a.pfm", pfm("PF", 1, 2, "-1.0", floats({1, 2, 3, 4, 5, 6}))).floats, expected);
  Bytes swapped;
  for (const uint32_t bits : {0x3f800000u, 0x40000000u}) swapped = swapped + big_32(bits);
  EXPECT_EQ(read("b.pfm", pfm("Pf", 2, 1, "0.5", swapped)).floats, (std::vector<float>{0.5f, 0.5f, 0.5f, 1, 1, 1}));
}

TEST(Texture, ExrOfOneChannelIsGrey) {
  const TemporaryFolder folder;
  const Image image{2, 1, {"Y"}, {{0.25f, 3}}};
  write_exr(folder.file("y.exr"), source_of(image), {});
  const ImageTexels texels = read_texture(folder.file("y.exr"), TextureEncoding::automatic);
  EXPECT_EQ(texels.floats, (std::vector<float>{0.25f, 0.25f, 0.25f, 3, 3, 3}));
}

TEST(Texture, ExrWithoutColourIsAnError) {
  const TemporaryFolder folder;
  const Image image{1, 1, {"R", "G"}, {{1}, {1}}};
  write_exr(folder.file("rg.exr"), source_of(image), {});
  EXPECT_THROW(read_texture(folder.file("rg.exr"), TextureEncoding::automatic), InputError);
}

TEST(Texture, TheContentsDecideNotTheName) {
  EXPECT_EQ(read("really-png.jpg", png(1, 1, 8, 0, {0, 3})).bytes, Bytes({3, 3, 3}));
}

TEST(Texture, MessagesSayWhatIsWrong) {
  const TemporaryFolder folder;
  EXPECT_THROW(read_texture(folder.file("none.png"), TextureEncoding::automatic), InputError);
  EXPECT_THROW(read_texture(folder.file(""), TextureEncoding::automatic), InputError);
  EXPECT_NE(error_of("empty.png", {}).find("empty"), std::string::npos);
  EXPECT_NE(error_of("a.gif", text("GIF89a....")).find("known format"), std::string::npos);
  EXPECT_NE(error_of("huge.pfm", pfm("PF", 65536, 65536, "-1", {})).find("2^30"), std::string::npos);
  EXPECT_NE(error_of("huge.png", png(40000, 40000, 8, 2, {})).find("2^30"), std::string::npos);
  EXPECT_NE(error_of("big.png", png(20000, 20000, 8, 2, {})).find("truncated"), std::string::npos);
  EXPECT_NE(error_of("nothing.tga", tga(2, 0, 5, 24, 0, {})).find("0 x 5"), std::string::npos);
}

struct NamedFile {
  std::string name;
  Bytes bytes;
};

std::vector<NamedFile> one_of_each() {
  const TemporaryFolder folder;
  Image image{4, 3, {"R", "G", "B"}, {}};
  image.planes.assign(3, std::vector<float>(12, 0.5f));
  write_exr(folder.file("a.exr"), source_of(image), {});
  return {{"a.png", png(2, 2, 8, 2, {0, 255, 0, 0, 0, 255, 0, 0, 0, 0, 255, 255, 255, 255})},
          {"b.png", png(2, 1, 16, 4, {0, 1, 2, 3, 4, 5, 6, 7, 8})},
          {"a.jpg", jpeg(3)},
          {"a.tga", tga(2, 2, 2, 24, 0, Bytes(12, 77))},
          {"b.tga", tga(10, 3, 2, 16, 0, {0x81, 1, 2, 3, 1, 2, 3, 4, 5, 6, 7, 8})},
          {"c.tga", tga(1, 2, 1, 8, 0, {1, 0}, {0, 0, 2, 0, 24}, {1, 2, 3, 4, 5, 6})},
          {"a.bmp", bmp(2, 2, 24, 0, {}, Bytes(16, 5))},
          {"b.bmp", bmp(2, 1, 4, 0, {1, 2, 3, 0, 4, 5, 6, 0}, {0x10, 0, 0, 0}, 2)},
          {"a.hdr", hdr(8, 1, {2, 2, 0, 8, 136, 128, 136, 64, 136, 0, 4, 129, 129, 129, 129, 132, 130})},
          {"b.hdr", hdr(4, 1, {128, 64, 0, 129, 1, 1, 1, 3})},
          {"c.hdr", text("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n+X 1 -Y 2\n") + Bytes{128, 64, 0, 129, 1, 2, 3, 4}},
          {"a.qoi", text("qoif") + big_32(3) + big_32(1) + Bytes{4, 0, 0xff, 1, 2, 3, 4, 0xc1, 0, 0, 0, 0, 0, 0, 0, 1}},
          {"a.pfm", pfm("PF", 1, 2, "-1.0", floats({1, 2, 3, 4, 5, 6}))},
          {"a.exr", read_file(folder.file("a.exr"))}};
}

TEST(Texture, TruncatedFilesAreErrors) {
  for (const NamedFile& file : one_of_each()) {
    EXPECT_EQ(error_of(file.name, file.bytes), "") << file.name;
    for (size_t length = 0; length < file.bytes.size(); ++length) {
      const Bytes cut(file.bytes.begin(), file.bytes.begin() + static_cast<std::ptrdiff_t>(length));
      EXPECT_NE(error_of(file.name, cut), "") << file.name << " cut after " << length << " bytes";
    }
  }
}

TEST(Texture, DamagedFilesAreReadOrRefused) {
  const TemporaryFolder folder;
  for (const NamedFile& file : one_of_each())
    for (size_t i = 0; i < file.bytes.size(); ++i)
      for (const int flip : {0x01, 0x10, 0x80, 0xff}) {
        Bytes damaged = file.bytes;
        damaged[i] = static_cast<uint8_t>(damaged[i] ^ flip);
        try {
          read_texture(folder.write(file.name, damaged), TextureEncoding::automatic);
          read_scalar_texture(folder.file(file.name), TextureEncoding::automatic);
        } catch (const InputError&) {
        }  // anything else fails the test
      }
}

TEST(Texture, GarbageBehindEverySignatureIsAnError) {
  Bytes garbage;
  for (uint32_t i = 0, state = 1; i < 400; ++i, state = state * 1664525 + 1013904223)
    garbage.push_back(static_cast<uint8_t>(state >> 24));
  for (const NamedFile& file : one_of_each()) {
    const Bytes head(file.bytes.begin(), file.bytes.begin() + 8);
    EXPECT_NE(error_of(file.name, head + garbage), "") << file.name;
  }
}

}  // namespace
}  // namespace alhazen::impl::test

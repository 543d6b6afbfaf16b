// Writing of images: EXR, PNG and PFM files, and atomic replacement of existing files.

#include "images/image.h"

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfTileDescription.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <cmath>
#include <csignal>
#include <limits>
#include <stdexcept>

#include "image_files.h"

namespace alhazen::impl::test {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

Image make_image(int width, int height, const std::vector<std::string>& channels) {
  Image image{width, height, channels, {}};
  float value = 0;
  for (size_t c = 0; c < channels.size(); ++c) {
    image.planes.emplace_back();
    for (int i = 0; i < width * height; ++i) image.planes.back().push_back(value += 0.25f);
  }
  return image;
}

Image grey_image(std::vector<float> values) {
  const int width = static_cast<int>(values.size());
  return {width, 1, {"R", "G", "B"}, {values, values, values}};
}

std::string render_error_of(const std::string& path, const Image& image) {
  try {
    has_written_extension(path) ? write_image(path, source_of(image), {}) : write_png(path, source_of(image), {});
  } catch (const RenderError& error) {
    return error.what();
  }
  return "";
}

TEST(Image, ExtensionsAreInLowerCase) {
  EXPECT_EQ(extension_of("a/b.EXR"), "exr");
  EXPECT_EQ(extension_of("a.b/c"), "");
  EXPECT_EQ(extension_of("x.tar.Png"), "png");
}

TEST(Image, SrgbCurveHasItsInverseAndItsEnds) {
  EXPECT_EQ(srgb_encode(0), 0);
  EXPECT_NEAR(srgb_encode(1), 1, 1e-12);
  EXPECT_NEAR(srgb_encode(0.18), 0.461356, 1e-6);
  for (int i = 0; i <= 255; ++i) EXPECT_NEAR(srgb_encode(srgb_decode(i / 255.0)), i / 255.0, 1e-7);
}

TEST(Exr, SingleFloatsComeBackExactly) {
  const TemporaryFolder folder;
  // Over two blocks of rows, in the order in which a reader returns channels.
  const Image image = make_image(5, 131, {"R", "G", "B", "A", "albedo.R", "albedo.G", "albedo.B", "depth.Z"});
  WriteOptions options;
  options.pixel_type = ExrPixelType::single;
  write_exr(folder.file("a.exr"), source_of(image), options);
  const Image back = read_image(folder.file("a.exr"));
  EXPECT_EQ(back.width, 5);
  EXPECT_EQ(back.height, 131);
  EXPECT_EQ(back.channels, image.channels);
  EXPECT_EQ(back.planes, image.planes);
  EXPECT_EQ(back.channel("albedo.G"), 5);
  EXPECT_EQ(back.channel("none"), -1);
}

TEST(Exr, HalfFloatsRoundAndClampButDepthDoesNot) {
  const TemporaryFolder folder;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> values{0.1f, 70000, infinity, -infinity, nan, 65519};
  const Image image{6, 1, {"R", "depth.Z"}, {values, values}};
  write_exr(folder.file("a.exr"), source_of(image), {});
  const Image back = read_image(folder.file("a.exr"));
  const std::vector<float>& red = back.planes[static_cast<size_t>(back.channel("R"))];
  EXPECT_NEAR(red[0], 0.1f, 5e-5f);
  EXPECT_EQ(red[1], 65504);
  EXPECT_EQ(red[2], 65504);
  EXPECT_EQ(red[3], -65504);
  EXPECT_TRUE(std::isnan(red[4]));
  EXPECT_EQ(red[5], 65504);
  const std::vector<float>& depth = back.planes[static_cast<size_t>(back.channel("depth.Z"))];
  EXPECT_EQ(depth[0], 0.1f);
  EXPECT_EQ(depth[1], 70000);
  EXPECT_EQ(depth[2], infinity);
}

TEST(Exr, HeaderHoldsMetadataAndWindows) {
  const TemporaryFolder folder;
  WriteOptions options;
  options.metadata = {{"software", "alhazen"}, {"alhazen.settings.of.a.long.name.over.31", "spp 16"}};
  options.x_offset = 10;
  options.y_offset = 20;
  options.full_width = 100;
  options.full_height = 50;
  write_exr(folder.file("a.exr"), source_of(make_image(4, 3, {"R", "G", "B"})), options);
  const Imf::InputFile file(folder.file("a.exr").c_str());
  const Imf::Header& header = file.header();
  EXPECT_EQ(header.dataWindow(), Imath::Box2i({10, 20}, {13, 22}));
  EXPECT_EQ(header.displayWindow(), Imath::Box2i({0, 0}, {99, 49}));
  EXPECT_EQ(header.compression(), Imf::ZIP_COMPRESSION);
  ASSERT_TRUE(Imf::hasChromaticities(header));
  EXPECT_EQ(Imf::chromaticities(header).green, Imath::V2f(0.30f, 0.60f)) << "those of sRGB";
  EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("software").value(), "alhazen");
  EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("alhazen.settings.of.a.long.name.over.31").value(), "spp 16");
  EXPECT_EQ(header.channels()["R"].type, Imf::HALF);
  EXPECT_EQ(read_image(folder.file("a.exr")).planes, make_image(4, 3, {"R", "G", "B"}).planes);
}

TEST(Exr, RowsAreAskedForInSmallBlocks) {
  const TemporaryFolder folder;
  int rows = 0;
  const ImageSource source{3, 200, {"R"}, [&](int y, std::span<float> row) {
                             ASSERT_EQ(row.size(), 3u);
                             row[0] = row[1] = row[2] = static_cast<float>(y);
                             ++rows;
                           }};
  write_exr(folder.file("a.exr"), source, {});
  EXPECT_EQ(rows, 200);
  EXPECT_EQ(read_image(folder.file("a.exr")).planes[0][199 * 3], 199.0f);
}

// Files that other programs write.

TEST(Exr, TiledFilesOfMixedTypes) {
  const TemporaryFolder folder;
  Imf::Header header(Imath::Box2i({0, 0}, {49, 39}), Imath::Box2i({-5, 7}, {14, 19}));
  header.channels().insert("F", Imf::Channel(Imf::FLOAT));
  header.channels().insert("U", Imf::Channel(Imf::UINT));
  header.setTileDescription(Imf::TileDescription(8, 8, Imf::ONE_LEVEL));
  header.compression() = Imf::PIZ_COMPRESSION;
  std::vector<float> singles(20 * 13);
  std::vector<unsigned> numbers(20 * 13);
  for (size_t i = 0; i < singles.size(); ++i) singles[i] = static_cast<float>(numbers[i] = static_cast<unsigned>(i));
  {
    Imf::TiledOutputFile file(folder.file("tiled.exr").c_str(), header);
    Imf::FrameBuffer frame;
    frame.insert("F", Imf::Slice::Make(Imf::FLOAT, singles.data(), header.dataWindow()));
    frame.insert("U", Imf::Slice::Make(Imf::UINT, numbers.data(), header.dataWindow()));
    file.setFrameBuffer(frame);
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
  }
  const Image image = read_image(folder.file("tiled.exr"));
  EXPECT_EQ(image.width, 20);
  EXPECT_EQ(image.height, 13);
  EXPECT_EQ(image.channels, (std::vector<std::string>{"F", "U"}));
  EXPECT_EQ(image.planes[0], singles);
  EXPECT_EQ(image.planes[1], singles);
}

TEST(Exr, FirstOfManyParts) {
  const TemporaryFolder folder;
  std::vector<Imf::Header> headers;
  for (const int size : {2, 3}) {
    headers.emplace_back(Imath::Box2i({0, 0}, {2, 2}), Imath::Box2i({0, 0}, {size - 1, size - 1}));
    headers.back().setName("part" + std::to_string(size));
    headers.back().setType(Imf::SCANLINEIMAGE);
    headers.back().channels().insert("Y", Imf::Channel(Imf::FLOAT));
  }
  const std::vector<float> values{1, 2, 3, 4, 5, 6, 7, 8, 9};
  {
    Imf::MultiPartOutputFile file(folder.file("parts.exr").c_str(), headers.data(), 2);
    for (int part = 0; part < 2; ++part) {
      Imf::OutputPart output(file, part);
      Imf::FrameBuffer frame;
      frame.insert("Y", Imf::Slice::Make(Imf::FLOAT, values.data(), headers[static_cast<size_t>(part)].dataWindow()));
      output.setFrameBuffer(frame);
      output.writePixels(2 + part);
    }
  }
  const Image image = read_image(folder.file("parts.exr"));
  EXPECT_EQ(image.width, 2);
  EXPECT_EQ(image.planes[0], (std::vector<float>{1, 2, 3, 4}));
}

TEST(Exr, SubsampledChannelsAreSpread) {
  const TemporaryFolder folder;
  Imf::Header header(4, 2);
  header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
  header.channels().insert("BY", Imf::Channel(Imf::FLOAT, 2, 2));
  const std::vector<float> luminance{1, 2, 3, 4, 5, 6, 7, 8}, chroma{10, 20};
  {
    Imf::OutputFile file(folder.file("yc.exr").c_str(), header);
    Imf::FrameBuffer frame;
    frame.insert("Y", Imf::Slice::Make(Imf::FLOAT, luminance.data(), header.dataWindow()));
    frame.insert("BY", Imf::Slice::Make(Imf::FLOAT, chroma.data(), header.dataWindow(), 4, 8, 2, 2));
    file.setFrameBuffer(frame);
    file.writePixels(2);
  }
  const Image image = read_image(folder.file("yc.exr"));
  EXPECT_EQ(image.planes[static_cast<size_t>(image.channel("Y"))], luminance);
  EXPECT_EQ(image.planes[static_cast<size_t>(image.channel("BY"))],
            (std::vector<float>{10, 10, 20, 20, 10, 10, 20, 20}));
}

TEST(Exr, MissingAndMalformedFilesNameThePath) {
  const TemporaryFolder folder;
  for (const std::string& path : {folder.file("none.exr"), folder.write("bad.exr", {0x76, 0x2f, 0x31, 0x01, 2, 0})})
    try {
      read_image(path);
      FAIL() << path;
    } catch (const InputError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with(path + ": ")) << error.what();
    }
}

// PNG.

TEST(Png, EncodesByTheSrgbCurve) {
  const TemporaryFolder folder;
  std::vector<float> values;
  for (int i = 0; i <= 1000; ++i) values.push_back(static_cast<float>(i) / 1000);
  write_png(folder.file("a.png"), source_of(grey_image(values)), {});
  const Image back = read_image(folder.file("a.png"));
  ASSERT_EQ(back.width, 1001);
  for (size_t i = 0; i < values.size(); ++i) {
    const double code = std::floor(255 * srgb_encode(static_cast<double>(values[i])) + 0.5);
    EXPECT_EQ(back.planes[0][i], static_cast<float>(srgb_decode(code / 255)));
  }
}

TEST(Png, EveryByteComesBack) {
  const TemporaryFolder folder;
  std::vector<float> values;
  for (int i = 0; i < 256; ++i) values.push_back(static_cast<float>(srgb_decode(i / 255.0)));
  write_png(folder.file("a.png"), source_of(grey_image(values)), {});
  EXPECT_EQ(read_image(folder.file("a.png")).planes[1], values);
}

TEST(Png, ClampsAndTurnsNanBlack) {
  const TemporaryFolder folder;
  const Image image = grey_image({-1, 2, infinity, -infinity, std::numeric_limits<float>::quiet_NaN()});
  for (const ToneMap map : {ToneMap::none, ToneMap::reinhard, ToneMap::filmic, ToneMap::aces, ToneMap::agx})
    for (const double white : {0.0, 3000.0}) {
      write_png(folder.file("a.png"), source_of(image), {.white_temperature = white, .tone_map = map});
      const std::vector<float> back = read_image(folder.file("a.png")).planes[2];
      EXPECT_EQ(back[0], 0);
      EXPECT_EQ(back[2], 1);
      EXPECT_EQ(back[3], 0);
      EXPECT_EQ(back[4], 0);
    }
}

TEST(Png, ExposureIsInStops) {
  const TemporaryFolder folder;
  write_png(folder.file("a.png"), source_of(grey_image({0.125f})), {.exposure = 3});
  EXPECT_EQ(read_image(folder.file("a.png")).planes[0][0], 1.0f);
}

TEST(Png, NeedsRedGreenAndBlue) {
  const TemporaryFolder folder;
  EXPECT_NE(render_error_of(folder.file("a.png"), make_image(1, 1, {"R", "G"})).find("no channel B"),
            std::string::npos);
  EXPECT_EQ(folder.count(), 0u);
}

// PFM.

TEST(Pfm, HoldsTheValuesAsTheyAreFromTheBottomUp) {
  const TemporaryFolder folder;
  const Image image{2, 2, {"depth.Z", "B", "G", "R"}, {{7, 7, 7, 7}, {3, -6, 9, 12}, {2, 5, 8, 11}, {1, 4, 1e30f, 10}}};
  write_pfm(folder.file("a.pfm"), source_of(image), {.exposure = 3, .tone_map = ToneMap::filmic});
  const Bytes expected = pfm("PF", 2, 2, "-1.0", floats({1e30f, 8, 9, 10, 11, 12, 1, 2, 3, 4, 5, -6}));
  EXPECT_EQ(read_file(folder.file("a.pfm")), expected);
  const Image back = read_image(folder.file("a.pfm"));
  EXPECT_EQ(back.planes, (std::vector<std::vector<float>>{image.planes[3], image.planes[2], image.planes[1]}));
}

TEST(Pfm, KeepsWhatIsNotFinite) {
  const TemporaryFolder folder;
  write_pfm(folder.file("a.pfm"), source_of(grey_image({infinity, -infinity, std::numeric_limits<float>::quiet_NaN()})),
            {});
  const std::vector<float> back = read_image(folder.file("a.pfm")).planes[1];
  EXPECT_EQ(back[0], infinity);
  EXPECT_EQ(back[1], -infinity);
  EXPECT_TRUE(std::isnan(back[2]));
}

TEST(Pfm, NeedsPixelsAndColours) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_pfm(folder.file("a.pfm"), source_of(make_image(1, 1, {"R", "G"})), {}), RenderError);
  EXPECT_THROW(write_pfm(folder.file("a.pfm"), source_of(Image{0, 0, {"R", "G", "B"}, {{}, {}, {}}}), {}), RenderError);
  EXPECT_EQ(folder.count(), 0u);
}

TEST(WriteImage, TheExtensionDecides) {
  const TemporaryFolder folder;
  const Image image = grey_image({0.25f, 0.5f});
  for (const char* name : {"a.exr", "a.PNG", "a.pfm", "a.jpg", "b.JPEG", "a.hdr"}) {
    EXPECT_TRUE(has_written_extension(name)) << name;
    write_image(folder.file(name), source_of(image), {});
    EXPECT_EQ(read_image(folder.file(name)).width, 2) << name;
  }
  EXPECT_FALSE(has_written_extension("a.tiff"));
  EXPECT_THROW(write_image(folder.file("a.tiff"), source_of(image), {}), RenderError);
  EXPECT_EQ(folder.count(), 6u);
  for (const char* name : {"a.png", "a.jpg", "a.jpeg"}) EXPECT_TRUE(is_displayed_format(name)) << name;
  for (const char* name : {"a.exr", "a.hdr", "a.pfm", "a.tiff", ""}) EXPECT_FALSE(is_displayed_format(name)) << name;
}

// Completely or not at all.

struct Interrupted {};

ImageSource interrupted_source() {
  return {600, 300, {"R", "G", "B"}, [](int y, std::span<float> row) {
            if (y == 290) throw Interrupted();
            for (float& value : row) value = static_cast<float>(y);
          }};
}

TEST(AtomicWrite, AFailingSourceLeavesTheOldFile) {
  const TemporaryFolder folder;
  const Bytes old{1, 2, 3};
  const std::string exr = folder.write("a.exr", old), png = folder.write("a.png", old),
                    pfm = folder.write("a.pfm", old), jpg = folder.write("a.jpg", old),
                    hdr = folder.write("a.hdr", old);
  EXPECT_THROW(write_exr(exr, interrupted_source(), {}), Interrupted);
  EXPECT_THROW(write_png(png, interrupted_source(), {}), Interrupted);
  EXPECT_THROW(write_jpg(jpg, interrupted_source(), {}), Interrupted);
  EXPECT_THROW(write_hdr(hdr, interrupted_source(), {}), Interrupted);
  // Rows go from the bottom up, so this source fails after nine of them.
  EXPECT_THROW(write_pfm(pfm, interrupted_source(), {}), Interrupted);
  EXPECT_EQ(read_file(exr), old);
  EXPECT_EQ(read_file(png), old);
  for (const std::string& path : {pfm, jpg, hdr}) EXPECT_EQ(read_file(path), old) << path;
  EXPECT_EQ(folder.count(), 5u);
}

TEST(AtomicWrite, ReplacesAndLeavesNoTemporary) {
  const TemporaryFolder folder;
  folder.write("a.png", {1, 2, 3});
  folder.write("a.exr", {1, 2, 3});
  EXPECT_EQ(render_error_of(folder.file("a.png"), grey_image({1, 0})), "");
  EXPECT_EQ(render_error_of(folder.file("a.exr"), grey_image({1, 0})), "");
  EXPECT_EQ(read_image(folder.file("a.png")).width, 2);
  EXPECT_EQ(read_image(folder.file("a.exr")).width, 2);
  EXPECT_EQ(folder.count(), 2u);
}

TEST(AtomicWrite, PermissionsAreThoseOfTheUmaskOrOfTheOldFile) {
  const TemporaryFolder folder;
  const auto mode_of = [&](const std::string& path) {
    struct stat status = {};
    EXPECT_EQ(::stat(path.c_str(), &status), 0);
    return status.st_mode & 0777;
  };
  const mode_t before = ::umask(027);
  EXPECT_EQ(render_error_of(folder.file("new.png"), grey_image({1})), "");
  ::umask(before);
  EXPECT_EQ(mode_of(folder.file("new.png")), 0640u);
  ::chmod(folder.file("new.png").c_str(), 0600);
  EXPECT_EQ(render_error_of(folder.file("new.png"), grey_image({1})), "");
  EXPECT_EQ(mode_of(folder.file("new.png")), 0600u);
}

TEST(AtomicWrite, FollowsLinks) {
  const TemporaryFolder folder;
  const std::string target = folder.write("target.png", {1});
  std::filesystem::create_symlink(target, folder.file("link.png"));
  EXPECT_EQ(render_error_of(folder.file("link.png"), grey_image({1})), "");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link.png")));
  EXPECT_EQ(read_image(target).width, 1);
}

TEST(AtomicWrite, FailuresSayPathCauseAndRemedy) {
  const TemporaryFolder folder;
  for (const char* name : {"none/a.png", "none/a.exr"}) {
    const std::string path = folder.file(name);
    EXPECT_EQ(render_error_of(path, grey_image({1})),
              "cannot write " + path + ": No such file or directory: the folder does not exist: create it first");
  }
  folder.write("file", {1});
  EXPECT_NE(render_error_of(folder.file("file/a.png"), grey_image({1})), "");
  EXPECT_NE(render_error_of(folder.file(""), grey_image({1})).find("directory"), std::string::npos);
  EXPECT_NE(render_error_of("", grey_image({1})), "");
}

TEST(AtomicWrite, AFolderThatIsReadOnly) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.file("closed"));
  ::chmod(folder.file("closed").c_str(), 0500);
  EXPECT_NE(render_error_of(folder.file("closed/a.exr"), grey_image({1})).find("Permission denied"), std::string::npos);
  ::chmod(folder.file("closed").c_str(), 0700);
}

TEST(AtomicWrite, AFullDisk) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_NE(render_error_of("/dev/full", make_image(300, 200, {"R", "G", "B"})).find("No space left"),
            std::string::npos);
  EXPECT_THROW(write_exr("/dev/full", source_of(make_image(300, 200, {"R"})), {}), RenderError);
}

/// A disk that is full after this number of bytes, for files written during its lifetime.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) : old_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &old_limit_);
    const rlimit limit{bytes, old_limit_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~SmallDisk() {
    ::setrlimit(RLIMIT_FSIZE, &old_limit_);
    std::signal(SIGXFSZ, old_handler_);
  }

 private:
  void (*old_handler_)(int);
  rlimit old_limit_{};
};

TEST(AtomicWrite, ADiskThatFillsUpAtAnyPoint) {
  const TemporaryFolder folder;
  const Image image = make_image(30, 100, {"R", "G", "B"});
  for (const char* name : {"a.exr", "a.png", "a.jpg", "a.hdr"}) {
    const std::string path = folder.file(name);
    EXPECT_EQ(render_error_of(path, image), "");
    const rlim_t size = read_file(path).size();
    const Bytes old{1, 2, 3};
    folder.write(name, old);
    for (rlim_t limit = 0; limit < size; limit += 1 + size / 50) {
      const SmallDisk disk(limit);
      EXPECT_NE(render_error_of(path, image).find("too large"), std::string::npos) << limit << " of " << size;
      EXPECT_EQ(read_file(path), old);
    }
    EXPECT_EQ(folder.count(), 1u);
    std::filesystem::remove(path);
  }
}

}  // namespace
}  // namespace alhazen::impl::test

// The public functions about images and devices: comparing, reading, PNG in memory.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "alhazen/compare.h"
#include "alhazen/devices.h"
#include "alhazen/read_image.h"
#include "alhazen/save.h"

namespace alhazen::impl {
namespace {

/// R, G, B and albedo.R, .G, .B, all of `value`.
RenderedImage constant_image(int width, int height, float value) {
  RenderedImage image;
  image.width = width;
  image.height = height;
  image.channels = {"R", "G", "B", "albedo.R", "albedo.G", "albedo.B"};
  image.planes.assign(6, std::vector<float>(static_cast<size_t>(width * height), value));
  return image;
}

std::string temporary(const std::string& name) {
  return (std::filesystem::temp_directory_path() / ("alhazen-image-tools-" + name)).string();
}

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const alhazen::InputError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(ImageTools, MeasuresOfConstantImages) {
  const RenderedImage a = constant_image(20, 10, 0.5f), b = constant_image(20, 10, 0.25f);
  const Comparison equal = compare(a, a), different = compare(a, b);
  EXPECT_EQ(equal.mse, 0);
  EXPECT_EQ(equal.flip, 0);
  EXPECT_TRUE(std::isinf(equal.psnr));
  EXPECT_DOUBLE_EQ(different.mse, 0.0625);
  EXPECT_NEAR(different.relmse, 0.0625 / 0.0725, 1e-12);
  EXPECT_DOUBLE_EQ(different.max_abs, 0.25);
  EXPECT_EQ(different.compared, 200);
  ASSERT_EQ(different.flip_map.size(), 200u);
  EXPECT_NEAR(different.flip_map[105], different.flip, 1e-3);
}

TEST(ImageTools, LayersRegionsAndMeansAreCompared) {
  RenderedImage a = constant_image(20, 10, 0.5f);
  const RenderedImage b = a;
  a.planes[4][0] = 1.5f;
  EXPECT_EQ(compare(a, b).mse, 0);
  EXPECT_GT(compare(a, b, {.layer = "albedo", .region = {}}).mse, 0);
  EXPECT_EQ(compare(a, b, {.layer = "albedo", .region = {{1, 0, 20, 10}}}).mse, 0);
  EXPECT_NEAR(compare(a, b, {.layer = "albedo", .region = {}, .reduce = 10}).max_abs, 0.01, 1e-7);  // floats
}

TEST(ImageTools, HeatMapHasTheColoursOfTheErrors) {
  const Comparison none = compare(constant_image(8, 8, 1), constant_image(8, 8, 1));
  const RenderedImage black = heat_map(none),
                      bright = heat_map(compare(constant_image(8, 8, 0), constant_image(8, 8, 1)));
  ASSERT_EQ(black.channels, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_LT(black.planes[0][9], 0.01f);
  EXPECT_GT(bright.planes[0][9], 0.5f);
  Comparison damaged = none;
  damaged.flip_map.pop_back();
  EXPECT_NE(message_of([&] { heat_map(damaged); }).find("flip_map"), std::string::npos);
}

TEST(ImageTools, WhatCannotBeComparedIsNamed) {
  const RenderedImage a = constant_image(8, 8, 1);
  RenderedImage damaged = a;
  damaged.planes.pop_back();
  EXPECT_NE(message_of([&] { compare(a, constant_image(8, 9, 1)); }).find("8 x 8 and 8 x 9"), std::string::npos);
  EXPECT_EQ(message_of([&] { compare(a, damaged); }).find("b: "), 0u);
  EXPECT_EQ(message_of([&] { compare(RenderedImage(), a); }).find("a: "), 0u);
  EXPECT_NE(message_of([&] { compare(a, a, {.layer = "smell", .region = {}}); }).find("'albedo'"), std::string::npos);
  EXPECT_NE(message_of([&] { compare(a, a, {.layer = {}, .region = {}, .reduce = 0}); }).find("reduced by 0"),
            std::string::npos);
}

TEST(ImageTools, ImagesAreReadAsTheyWereSaved) {
  RenderedImage image = constant_image(5, 4, 0.5f);
  image.planes[1][3] = 100;
  const std::string file = temporary("read.exr");
  save(image, file);
  const RenderedImage read = read_image(file);
  EXPECT_EQ(read.width, 5);
  EXPECT_EQ(read.height, 4);
  for (const std::string& channel : image.channels) {
    ASSERT_NE(read.plane(channel), nullptr) << channel;
    EXPECT_TRUE(std::equal(read.plane(channel), read.plane(channel) + 20, image.plane(channel))) << channel;
  }
  std::filesystem::remove(file);
  EXPECT_EQ(message_of([&] { read_image(file); }).find(file), 0u);
}

TEST(ImageTools, PngInMemoryIsThatOfAFile) {
  const RenderedImage image = constant_image(5, 4, 2.5f);
  const std::string file = temporary("png.png");
  SaveOptions options;
  options.exposure = -1;
  options.tone_mapping = ToneMapping::aces;
  options.png_depth = 16;
  save(image, file, options);
  std::ifstream stream(file, std::ios::binary);
  const std::vector<uint8_t> written{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_EQ(encode_png(image, options), written);
  std::filesystem::remove(file);
  options.png_depth = 7;
  EXPECT_NE(message_of([&] { encode_png(image, options); }).find("png_depth"), std::string::npos);
  RenderedImage grey = image;
  grey.channels[0] = "grey";
  EXPECT_THROW(encode_png(grey), Error);
}

TEST(ImageTools, DevicesHaveTheSerialBackendAndTheBuiltinDenoiser) {
  const Devices all = devices();
  EXPECT_TRUE(std::any_of(all.backends.begin(), all.backends.end(),
                          [](const BackendInfo& backend) { return backend.name == "serial" && backend.available; }));
  EXPECT_TRUE(std::any_of(all.denoisers.begin(), all.denoisers.end(), [](const DenoiserInfo& denoiser) {
    return denoiser.name == "builtin" && denoiser.available;
  }));
  EXPECT_GE(all.processors, 1);
  EXPECT_FALSE(all.instruction_sets.empty());
  for (const BackendInfo& backend : all.backends) EXPECT_FALSE(backend.details.empty()) << backend.name;
}

}  // namespace
}  // namespace alhazen::impl

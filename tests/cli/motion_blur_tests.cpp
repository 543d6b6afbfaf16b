// --shutter: motion blur of glTF animations, and what is said of motion that is not blurred.

#include "alhazen/alhazen.h"
#include "cli/fixture.h"
#include "support/animated_gltf.h"

namespace alhazen::impl::test {

namespace {

class MotionBlur : public Command {
 protected:
  CommandResult shot(const std::string& scene, const std::vector<std::string>& arguments,
                     const std::string& out) const {
    std::vector<std::string> all{"render", scene, "--size", "32x32", "--spp", "64", "-q", "-o", out};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return run(all);
  }

  Image frame(const std::string& scene, const std::vector<std::string>& arguments) const {
    const CommandResult result = shot(scene, arguments, "out.exr");
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    return image("out.exr");
  }

  static const std::vector<float>& green(const Image& image) {
    return image.planes.at(static_cast<size_t>(image.channel("G")));
  }

  /// The width in pixels of what is green in the middle row.
  static int width_of_green(const Image& image) {
    int count = 0;
    for (int x = 0; x < image.width; ++x)
      count += green(image)[static_cast<size_t>(image.height / 2 * image.width + x)] > 1e-4f;
    return count;
  }

  void expect_warning(const std::vector<AnimatedChannel>& channels, const std::string& words,
                      const std::vector<std::string>& arguments = {"--time", "0", "--shutter", "1", "--fps", "1"}) {
    write_animated_gltf(folder_, "warned", channels);
    const CommandResult result = shot("warned.gltf", arguments, "w.exr");
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    EXPECT_NE(result.err.find(words), std::string::npos) << words << "\n" << result.err;
  }
};

/// The mean over the time that the shutter is open: as the mean of many images at rest.
TEST_F(MotionBlur, IsTheMeanOverTheTimeOfTheShutter) {
  write_animated_gltf(folder_, "moving", {{0, "translation", {0, 1}, {0, 0, 0, 2, 0, 0}}});
  const std::vector<std::string> half{"--time", "0.25", "--fps", "1", "--shutter", "0.5"};
  const Image blurred = frame("moving.gltf", half);
  std::vector<double> mean(green(blurred).size());
  constexpr int shots = 32;
  for (int i = 0; i < shots; ++i) {
    const Image sharp = frame("moving.gltf", {"--time", std::to_string(0.25 + 0.5 * (i + 0.5) / shots)});
    for (size_t p = 0; p < mean.size(); ++p) mean[p] += static_cast<double>(green(sharp)[p]) / shots;
  }
  double error = 0, size = 0;
  for (size_t p = 0; p < mean.size(); ++p) {
    error += std::abs(mean[p] - static_cast<double>(green(blurred)[p]));
    size += mean[p];
  }
  EXPECT_LT(error, 0.08 * size);
  EXPECT_GT(width_of_green(blurred), width_of_green(frame("moving.gltf", {"--time", "0.25"})) + 2);
}

TEST_F(MotionBlur, IsOffByDefaultAndWithAClosedShutter) {
  write_animated_gltf(folder_, "moving", {{0, "translation", {0, 1}, {0, 0, 0, 2, 0, 0}}});
  const Image sharp = frame("moving.gltf", {"--time", "0.25"});
  EXPECT_EQ(frame("moving.gltf", {"--time", "0.25", "--shutter", "0"}).planes, sharp.planes);
  EXPECT_NE(frame("moving.gltf", {"--time", "0.25", "--shutter", "1"}).planes, sharp.planes);
  const Image wide = frame("moving.gltf", {"--time", "0", "--shutter", "1", "--fps", "2"}),
              narrow = frame("moving.gltf", {"--time", "0", "--shutter", "0.5", "--fps", "2"});
  EXPECT_GT(width_of_green(wide), width_of_green(narrow) + 3);
}

/// As part of a sequence, the bits are those of the frame alone.
TEST_F(MotionBlur, OfFramesHasTheBitsOfOneAlone) {
  write_animated_gltf(folder_, "moving", {{0, "translation", {0, 1}, {0, 0, 0, 2, 0, 0}}});
  ASSERT_EQ(shot("moving.gltf", {"--frames", "0..2", "--fps", "4", "--shutter", "0.5"}, "f_#.exr").exit_code, 0);
  EXPECT_EQ(frame("moving.gltf", {"--time", "0.25", "--fps", "4", "--shutter", "0.5"}).planes, image("f_1.exr").planes);
}

/// The same settings in the library.
TEST_F(MotionBlur, IsASettingOfTheLibrary) {
  write_animated_gltf(folder_, "moving", {{0, "translation", {0, 1}, {0, 0, 0, 2, 0, 0}}});
  Settings settings;
  settings.samples_per_pixel = 64;
  settings.width = settings.height = 32;
  settings.animation_time = 0.25;
  settings.frames_per_second = 4;
  settings.shutter = 0.5;
  const RenderedImage rendered = alhazen::render(folder_.file("moving.gltf"), settings);
  const std::vector<std::string> arguments{"--time", "0.25", "--fps", "4", "--shutter", "0.5", "--exr-type", "float"};
  const Image written = frame("moving.gltf", arguments);
  EXPECT_EQ(std::vector<float>(rendered.plane("G"), rendered.plane("G") + 32 * 32), green(written));
  settings.shutter = 2;
  EXPECT_THROW(alhazen::render(folder_.file("moving.gltf"), settings), std::runtime_error);
  settings.shutter = 0;
  settings.frames_per_second = 0;
  EXPECT_THROW(alhazen::render(folder_.file("moving.gltf"), settings), std::runtime_error);
}

TEST_F(MotionBlur, LeavesWhatMovesInStepsWhereItIs) {
  write_animated_gltf(folder_, "steps", {{0, "translation", {0, 0.5, 1}, {0, 0, 0, 1, 0, 0, 2, 0, 0}, "STEP"}});
  const Image sharp = frame("steps.gltf", {"--time", "0.4"});
  EXPECT_EQ(frame("steps.gltf", {"--time", "0.4", "--fps", "1", "--shutter", "0.5"}).planes, sharp.planes);
}

TEST_F(MotionBlur, SaysWhatIsNotBlurred) {
  const std::vector<float> second{0, 1};
  expect_warning({{0, "weights", second, {0, 1}}}, "morph targets move while the shutter is open");
  expect_warning({{1, "translation", second, {0, 0, 4, 0, 0, 8}}}, "the camera moves; it is rendered at rest");
  expect_warning({{2, "rotation", second, {0, 0, 0, 1, 0.7f, 0, 0, 0.7f}}}, "lights move while the shutter is open");
  const float half = 0.70710678f;
  expect_warning({{0, "rotation", second, {0, 0, 0, 1, 0, 0, half, half}}}, "moves along a curve or turns");
  expect_warning({{0, "rotation", second, {0, 0, 0, 1, 0, 0, 1, 0}}}, "turns too far, or becomes flat");
  expect_warning({{1, "translation", second, {0, 0, 4, 0, 0, 8}}}, "its motion is not blurred",
                 {"--frames", "0", "--shutter", "0.5"});
  write_animated_gltf(folder_, "light", {{0, "translation", second, {0, 0, 0, 1, 0, 0}}}, 1);
  const CommandResult emissive = shot("light.gltf", {"--shutter", "1", "--fps", "1"}, "w.exr");
  EXPECT_NE(emissive.err.find("an emissive mesh moves; it is rendered at rest"), std::string::npos) << emissive.err;
  // A small turn is blurred, and nothing is said.
  write_animated_gltf(folder_, "turn", {{0, "rotation", second, {0, 0, 0, 1, 0, 0, 0.05f, 0.99875f}}});
  const CommandResult quiet = shot("turn.gltf", {"--shutter", "1", "--fps", "1"}, "w.exr");
  EXPECT_EQ(quiet.err, "") << quiet.err;
}

}  // namespace

}  // namespace alhazen::impl::test

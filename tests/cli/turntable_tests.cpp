// --turntable, and the middle of the scene that it, --orbit and --fit use.

#include <cmath>

#include "cli/fixture.h"

namespace alhazen::impl::test {

namespace {

/// A red ball on the left, a blue one on the right, one behind the other from the side; with z or y upwards.
std::string two_balls(const std::string& camera, const std::string& more = "") {
  return camera + R"(
Film "rgb" "integer xresolution" 32 "integer yresolution" 24
PixelFilter "box"
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
Material "diffuse" "rgb reflectance" [ 0.8 0.1 0.1 ]
AttributeBegin Translate -1.5 0 0 Shape "sphere" "float radius" 0.6 AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.1 0.1 0.8 ]
AttributeBegin Translate 1.5 0 0 Shape "sphere" "float radius" 0.6 AttributeEnd
)" + more;
}

class Turntable : public Command {
 protected:
  CommandResult turn(const std::vector<std::string>& arguments) const {
    std::vector<std::string> all{"render", "balls.pbrt", "--spp", "16", "-q", "--aov", "depth"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const CommandResult result = run(all);
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    return result;
  }

  static const std::vector<float>& plane(const Image& image, const char* channel) {
    return image.planes.at(static_cast<size_t>(image.channel(channel)));
  }

  struct Seen {
    double red = 0, blue = 0;                  ///< mean column of each ball, from the middle of the image
    double row = 0;                            ///< mean row of both
    double red_depth = 1e9, blue_depth = 1e9;  ///< of the nearest point
  };

  Seen seen(const std::string& name) const {
    const Image image = this->image(name);
    Seen result;
    double red = 0, blue = 0;
    for (size_t i = 0; i < plane(image, "R").size(); ++i) {
      const double depth = static_cast<double>(plane(image, "depth.Z")[i]);
      if (!(depth > 0)) continue;
      const double x = static_cast<double>(i % static_cast<size_t>(image.width)) + 0.5 - image.width / 2.0;
      const bool is_red = plane(image, "R")[i] > plane(image, "B")[i];
      (is_red ? result.red : result.blue) += x;
      (is_red ? red : blue) += 1;
      result.row += static_cast<double>(i / static_cast<size_t>(image.width)) + 0.5;
      double& nearest = is_red ? result.red_depth : result.blue_depth;
      nearest = std::min(nearest, depth);
    }
    result.row /= red + blue;
    result.red /= red > 0 ? red : 1;
    result.blue /= blue > 0 ? blue : 1;
    return result;
  }
};

const std::string turned_perspective = " Camera \"perspective\" \"float fov\" 40";

/// In every frame as --orbit shows the scene from there, upright, whichever axis of the world is up.
TEST_F(Turntable, GoesRoundAsTheAzimuthOfOrbitDoes) {
  for (const std::string camera :
       {"LookAt 0 -6 2  0 0 0  0 0 1", "LookAt 0 2 -6  0 0 0  0 1 0", "Scale -1 1 1 LookAt 0 2 -6  0 0 0  0 1 0"}) {
    SCOPED_TRACE(camera);
    folder_.write_text("balls.pbrt", two_balls(camera + turned_perspective));
    turn({"--orbit", "0,10,8", "--turntable", "4", "-o", "t_#.exr"});
    for (int i = 0; i < 4; ++i) {
      SCOPED_TRACE(i);
      turn({"--orbit", std::to_string(90 * i) + ",10,8", "-o", "still.exr"});
      const Seen frame = seen("t_" + std::to_string(i) + ".exr"), still = seen("still.exr");
      EXPECT_NEAR(frame.red, still.red, 0.1);
      EXPECT_NEAR(frame.blue, still.blue, 0.1);
      EXPECT_NEAR(frame.row, still.row, 0.1);
    }
    EXPECT_LT(seen("t_0.exr").red, -3);
    EXPECT_GT(seen("t_2.exr").red, 3);
    EXPECT_LT(seen("t_1.exr").blue_depth, seen("t_1.exr").red_depth - 1) << "from the right, where the blue one is";
  }
}

/// The first frame is the still image; without options the scene's own camera turns.
TEST_F(Turntable, BeginsWithTheViewOfTheStillImage) {
  folder_.write_text("balls.pbrt", two_balls("LookAt 1 -6 2  0 0 0  0 0 1" + turned_perspective));
  turn({"--turntable", "3", "-o", "t_#.exr"});
  turn({"-o", "still.exr"});
  EXPECT_EQ(image("t_0.exr").planes, image("still.exr").planes);
  EXPECT_NE(image("t_1.exr").planes, image("still.exr").planes);
}

TEST_F(Turntable, FramesHaveTheBitsOfTheSameFrameAlone) {
  folder_.write_text("balls.pbrt", two_balls("LookAt 1 -6 2  0 0 0  0 0 1" + turned_perspective));
  turn({"--turntable", "6", "-o", "t_#.exr"});
  turn({"--turntable", "6", "--frames", "4", "-o", "alone_#.exr"});
  EXPECT_EQ(image("alone_4.exr").planes, image("t_4.exr").planes);
  EXPECT_FALSE(exists("alone_3.exr"));
}

TEST_F(Turntable, IsReadAndBuiltOnce) {
  folder_.write_text("balls.pbrt", two_balls("LookAt 1 -6 2  0 0 0  0 0 1" + turned_perspective));
  const std::vector<std::string> lines = lines_of(turn({"--turntable", "3", "-o", "t_#.exr", "--stats=json"}).out);
  ASSERT_EQ(lines.size(), 3u);
  for (size_t i = 0; i < 3; ++i) {
    const double built = nlohmann::json::parse(lines[i])["build_seconds"].get<double>();
    EXPECT_TRUE(i == 0 ? built > 0 : built < 1e-4) << lines[i];
  }
}

/// With --fit both balls are in the image from all sides, at the same distance.
TEST_F(Turntable, FitsFromAllSides) {
  folder_.write_text("balls.pbrt", two_balls("LookAt 6 -1 2  0 0 0  0 0 1" + turned_perspective));
  turn({"--turntable", "8", "--fit", "-o", "t_#.exr"});
  for (int i = 0; i < 8; ++i) {
    const Image frame = image("t_" + std::to_string(i) + ".exr");
    const std::vector<float>& depth = plane(frame, "depth.Z");
    const size_t width = static_cast<size_t>(frame.width), height = static_cast<size_t>(frame.height);
    for (size_t x = 0; x < width; ++x) EXPECT_TRUE(!(depth[x] > 0) && !(depth[(height - 1) * width + x] > 0));
    for (size_t y = 0; y < height; ++y) EXPECT_TRUE(!(depth[y * width] > 0) && !(depth[y * width + width - 1] > 0));
  }
  EXPECT_GT(std::abs(seen("t_2.exr").blue - seen("t_2.exr").red), 10)
      << "and they fill it from where they are side by side";
}

TEST_F(Turntable, RefusesWhatMakesNoSense) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"--turntable", "0"},
                                             {"--turntable=-4"},
                                             {"--turntable", "x"},
                                             {"--turntable", "9999999"},
                                             {"--turntable", "4", "--frames", "2..4"},
                                             {"--turntable", "4", "--checkpoint", "c"}}) {
    std::vector<std::string> all = arguments;
    all.insert(all.end(), {"-o", "t_#.exr"});
    const CommandResult result = render(all);
    EXPECT_EQ(result.exit_code, 2) << result.everything();
  }
  EXPECT_EQ(render({"--turntable", "4", "-o", "t.exr"}).exit_code, 2);
  EXPECT_EQ(folder_.count(), 1u);
}

/// A floor of few vertices, far larger and to one side, moves neither the middle nor the view that fits.
TEST_F(Turntable, AFloorDoesNotMoveTheMiddle) {
  const std::string camera = "LookAt 1 -6 2  0 0 0  0 0 1" + turned_perspective;
  const std::string floor =
      "Material \"diffuse\" \"rgb reflectance\" [ 0.02 0.02 0.02 ] Shape \"trianglemesh\" \"point3 P\" [ -2 -2 -0.7  "
      "38 -2 "
      "-0.7  38 38 -0.7  -2 38 -0.7 ] \"integer indices\" [ 0 1 2 0 2 3 ]";
  folder_.write_text("balls.pbrt", two_balls(camera));
  turn({"--orbit", "0,20", "-o", "bare.exr"});
  folder_.write_text("balls.pbrt", two_balls(camera, floor));
  turn({"--orbit", "0,20", "-o", "floor.exr"});
  const Image bare = image("bare.exr"), with_floor = image("floor.exr");
  const auto nearest = [&](const Image& image) {
    float least = 1e9f;
    for (size_t i = 0; i < plane(image, "R").size(); ++i)
      if (plane(image, "depth.Z")[i] > 0 && plane(image, "R")[i] > 3 * plane(image, "G")[i])
        least = std::min(least, plane(image, "depth.Z")[i]);
    return least;
  };
  EXPECT_NEAR(nearest(with_floor), nearest(bare), 0.02f * nearest(bare));
}

}  // namespace

}  // namespace alhazen::impl::test

// Sequences of frames from the command line: their numbers, names and times, and what happens where some are there.

#include <csignal>

#include "cli/fixture.h"
#include "support/animated_gltf.h"

namespace alhazen::impl::test {

namespace {

class Frames : public Command {
 protected:
  /// The triangle moves to the right by 40 units in a second.
  Frames() { write_animated_gltf(folder_, "moving", {{0, "translation", {0, 1}, {0, 0, 0, 40, 0, 0}}}); }

  CommandResult moving(const std::vector<std::string>& arguments, const CommandOptions& options = {}) const {
    std::vector<std::string> all{"render", "moving.gltf", "--size", "24x24", "--spp", "4", "--progress", "none"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return run(all, options);
  }

  Bytes bytes(const std::string& name) const { return read_file(folder_.file(name)); }

  /// The mean column of what is green, 0 to 1; -1 if nothing is.
  static double column_of_green(const Image& image) {
    const std::vector<float>& green = image.planes.at(static_cast<size_t>(image.channel("G")));
    double sum = 0, weight = 0;
    for (size_t i = 0; i < green.size(); ++i) {
      weight += static_cast<double>(green[i]);
      sum += static_cast<double>(green[i]) * (static_cast<double>(i % static_cast<size_t>(image.width)) + 0.5) /
             image.width;
    }
    return weight > 0 ? sum / weight : -1;
  }

  void expect_refused(const std::vector<std::string>& arguments, const std::string& word) const {
    const size_t before = folder_.count();
    const CommandResult result = moving(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.everything();
    EXPECT_NE(result.err.find(word), std::string::npos) << word << "\n" << result.err;
    EXPECT_EQ(lines_of(result.err).size(), 1u) << result.err;
    EXPECT_EQ(folder_.count(), before);
  }
};

TEST_F(Frames, HaveNumbersInTheirNamesAndTimesByTheFrameRate) {
  const CommandResult result =
      moving({"--frames", "0..4:2", "--fps", "200", "-o", "a_%04d.png", "-o", "b_##.exr", "--exposure", "0"});
  ASSERT_EQ(result.exit_code, 0) << result.everything();
  for (const char* name : {"a_0000.png", "a_0002.png", "a_0004.png", "b_00.exr", "b_02.exr", "b_04.exr"})
    EXPECT_TRUE(exists(name)) << name;
  EXPECT_EQ(folder_.count(), 3u + 6u);
  EXPECT_NE(result.err.find("frame 2 (2 of 3): "), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("wrote a_0004.png, b_04.exr"), std::string::npos) << result.err;
  // 4 frames of a 200th of a second: 0.8 units of about 2.9 that the image shows.
  const double first = column_of_green(image("b_00.exr")), last = column_of_green(image("b_04.exr"));
  EXPECT_NEAR(last - first, 0.8 / 2.9, 0.04);
}

/// Also for one frame of a sequence, and with what --time renders.
TEST_F(Frames, HaveTheBitsOfTheSameFrameAlone) {
  ASSERT_EQ(moving({"--frames", "3..6", "--fps", "100", "-o", "all_#.png"}).exit_code, 0);
  ASSERT_EQ(moving({"--frames", "5", "--fps", "100", "-o", "alone_%d.png"}).exit_code, 0);
  EXPECT_EQ(bytes("alone_5.png"), bytes("all_5.png"));
  EXPECT_NE(bytes("all_4.png"), bytes("all_5.png"));
  ASSERT_EQ(moving({"--time", "0.05", "-o", "still.png"}).exit_code, 0);
  EXPECT_EQ(bytes("still.png"), bytes("all_5.png"));
}

TEST_F(Frames, StatisticsNameTheirFrame) {
  const CommandResult result = moving({"--frames", "7..8", "-o", "f_##.exr", "--stats=json", "-q"});
  ASSERT_EQ(result.exit_code, 0) << result.everything();
  const std::vector<std::string> lines = lines_of(result.out);
  ASSERT_EQ(lines.size(), 2u) << result.out;
  for (size_t i = 0; i < 2; ++i) EXPECT_EQ(nlohmann::json::parse(lines[i])["frame"], 7 + static_cast<int>(i));
  const CommandResult text = moving({"--frames", "9", "-o", "f_##.exr", "--stats", "-q"});
  EXPECT_EQ(text.out.find("frame   9\nload"), 0u) << text.out;
}

TEST_F(Frames, ProgressNamesTheFrame) {
  const CommandResult shown = run({"render", "moving.gltf", "--size", "24x24", "--spp", "4", "--frames", "4..5", "-o",
                                   "f_##.exr", "--progress", "json"});
  ASSERT_EQ(shown.exit_code, 0) << shown.everything();
  EXPECT_NE(shown.err.find("\"frame\":5,\"frame_index\":2,\"frame_count\":2"), std::string::npos) << shown.err;
}

TEST_F(Frames, ThatAreThereAreLeftAsTheyAre) {
  ASSERT_EQ(moving({"--frames", "0..2", "-o", "f_##.png"}).exit_code, 0);
  const Bytes first = bytes("f_00.png");
  folder_.write_text("f_01.png", "not an image");
  std::filesystem::remove(folder_.file("f_02.png"));
  const CommandResult again = moving({"--frames", "0..3", "-o", "f_##.png"});
  EXPECT_EQ(again.exit_code, 0) << again.everything();
  EXPECT_NE(again.err.find("2 of 4 frames are there and are left as they are; --overwrite renders them again"),
            std::string::npos)
      << again.err;
  EXPECT_EQ(bytes("f_01.png"), Bytes({'n', 'o', 't', ' ', 'a', 'n', ' ', 'i', 'm', 'a', 'g', 'e'}));
  EXPECT_TRUE(exists("f_02.png") && exists("f_03.png"));
  const CommandResult none = moving({"--frames", "0..3", "-o", "f_##.png"});
  EXPECT_EQ(none.exit_code, 0);
  EXPECT_EQ(lines_of(none.err).size(), 1u) << none.err;
  // A frame of two files is there when both are.
  EXPECT_EQ(moving({"--frames", "1", "-o", "f_##.png", "-o", "f_##.exr"}).exit_code, 0);
  EXPECT_NO_THROW(image("f_01.png"));
  folder_.write_text("f_00.png", "no");
  EXPECT_EQ(moving({"--frames", "0..3", "-o", "f_##.png", "--overwrite"}).exit_code, 0);
  EXPECT_EQ(bytes("f_00.png"), first);
}

/// A file without a byte is no image.
TEST_F(Frames, WithEmptyFilesAreRenderedAgain) {
  ASSERT_EQ(moving({"--frames", "0..1", "-o", "f_#.png"}).exit_code, 0);
  const Bytes first = bytes("f_1.png");
  folder_.write_text("f_1.png", "");
  const CommandResult again = moving({"--frames", "0..1", "-o", "f_#.png"});
  EXPECT_EQ(again.exit_code, 0) << again.everything();
  EXPECT_NE(again.err.find("1 of 2 frames are there"), std::string::npos) << again.err;
  EXPECT_EQ(bytes("f_1.png"), first);
}

TEST_F(Frames, AnInterruptKeepsFinishedOnesAndNothingElse) {
  CommandOptions options;
  options.signal_when = [](const std::string& err) {
    return err.find("frame 1 (2 of 1000): ") != std::string::npos ? SIGINT : 0;
  };
  const CommandResult result = run({"render", "moving.gltf", "--frames", "0..999", "--size", "300x300", "--spp", "16",
                                    "-o", "f_####.png", "--progress", "none"},
                                   options);
  EXPECT_EQ(result.exit_code, 130) << result.everything();
  EXPECT_NE(result.err.find("interrupted: the frames that are finished are kept"), std::string::npos) << result.err;
  ASSERT_TRUE(exists("f_0000.png") && exists("f_0001.png"));
  size_t finished = 0;
  while (exists("f_" + std::string(finished < 10 ? "000" : "00") + std::to_string(finished) + ".png")) ++finished;
  EXPECT_EQ(folder_.count(), 3 + finished) << "no partial frame, no temporary file";
}

TEST_F(Frames, RefusesRangesThatMakeNoSense) {
  for (const char* range : {"", "5..1", "1..", "..3", "a..b", "1..2:0", "1..2:x", "3:2", "1...2", "1.5..3", "0..1:2:3",
                            "1e99", "0..2000000", "0..99999999999", "9999999999"})
    expect_refused({"--frames", range, "-o", "f_##.png"}, "--frames");
  expect_refused({"--frames=-3..2", "-o", "f_##.png"}, "frames are numbered from 0");
  expect_refused({"--frames=3..-2", "-o", "f_##.png"}, "frames are numbered from 0");
  for (const char* rate : {"0", "-1", "nan", "1e9", "x"})
    expect_refused({"--frames", "0..1", "--fps", rate, "-o", "f_##.png"}, "--fps");
  for (const char* shutter : {"-0.1", "1.5", "nan"})
    expect_refused({"--frames", "0..1", "--shutter", shutter, "-o", "f_##.png"}, "--shutter");
  expect_refused({"--frames", "0..1", "--time", "1", "-o", "f_##.png"}, "--time is for one image");
  expect_refused({"--frames", "0..1", "--checkpoint", "c", "-o", "f_##.png"}, "--checkpoint");
  expect_refused({"--frames", "0..1"}, "frames need names");
}

TEST_F(Frames, RefusesNamesThatAreNoPattern) {
  for (const char* name : {"f_%s.png", "f_%04d%04d.png", "f_##_##.png", "f_%n.png", "f_%99999999d.png", "f_%4d.png",
                           "f_%0d.png", "f_%.png", "f_%-4d.png", "f_##########.png", "f_#%d.png", "f_%04x.png"})
    expect_refused({"--frames", "0..1", "-o", name}, "%04d or ####");
  expect_refused({"--frames", "0..1", "-o", "f.png"}, "2 frames cannot have one name");
  expect_refused({"--frames", "0..1", "-o", "f_##.png", "-o", "f.exr"}, "2 frames cannot have one name");
  expect_refused({"--frames", "0..1", "-o", "f_##.tiff"}, "images are written as");
  expect_refused({"--frames", "0..1", "-o", "none/f_##.png"}, "folder");
  expect_refused({"--frames", "0..1", "-o", "-"}, "one image");
}

TEST_F(Frames, ANameMayHaveOtherSigns) {
  std::filesystem::create_directory(folder_.file("100%_#d"));
  const CommandResult result = moving({"--frames", "12", "-o", "100%_#d/50%%_%02d.png"});
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_TRUE(exists("100%_#d/50%_12.png"));
  EXPECT_EQ(moving({"--frames", "12", "-o", "plain.png"}).exit_code, 0) << "one frame needs no number";
  EXPECT_TRUE(exists("plain.png"));
}

TEST_F(Frames, WarnsOfAPatternInTheNameOfOneImage) {
  for (const char* name : {"one_%04d.png", "one_####.png"}) {
    const CommandResult result = moving({"-o", name});
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    EXPECT_NE(result.err.find("one image is rendered, and its name is taken as it is"), std::string::npos)
        << result.err;
    EXPECT_TRUE(exists(name));
  }
  EXPECT_EQ(moving({"-o", "plain.png"}).err.find("is taken as it is"), std::string::npos);
}

/// No frame may replace a file that the scene is read from.
TEST_F(Frames, RefusesToReplaceItsInput) {
  std::filesystem::copy(folder_.file("moving.bin"), folder_.file("keep.bin"));
  folder_.write_text("a_0.exr", "x");
  std::filesystem::remove(folder_.file("a_0.exr"));
  std::filesystem::create_hard_link(folder_.file("moving.bin"), folder_.file("a_1.exr"));
  const CommandResult result = moving({"--frames", "0..1", "-o", "a_#.exr", "--overwrite"});
  EXPECT_EQ(result.exit_code, 2) << result.everything();
  EXPECT_EQ(bytes("moving.bin"), bytes("keep.bin"));
}

/// The whole is read and built once where the camera alone moves.
TEST_F(Frames, OfAMovingCameraAreBuiltOnce) {
  write_animated_gltf(folder_, "camera", {{1, "translation", {0, 1}, {0, 0, 4, 2, 0, 8}}});
  const auto frames = [&](const std::string& range, const std::string& name) {
    const CommandResult result = run({"render", "camera.gltf", "--size", "24x24", "--spp", "4", "--progress", "none",
                                      "--fps", "4", "--frames", range, "-o", name, "--stats=json", "-q"});
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    return lines_of(result.out);
  };
  const std::vector<std::string> lines = frames("0..3", "c_#.exr");
  ASSERT_EQ(lines.size(), 4u);
  for (size_t i = 1; i < 4; ++i) {
    EXPECT_LT(nlohmann::json::parse(lines[i])["build_seconds"].get<double>(), 1e-4) << lines[i];
  }
  frames("2", "alone_#.exr");
  const Image alone = image("alone_2.exr"), all = image("c_2.exr");
  EXPECT_EQ(alone.planes, all.planes);
  // As the camera at that time sees it, and not as at another.
  ASSERT_EQ(run({"render", "camera.gltf", "--size", "24x24", "--spp", "4", "-q", "--time", "0.5", "-o", "still.exr"})
                .exit_code,
            0);
  EXPECT_EQ(image("still.exr").planes, all.planes);
  EXPECT_NE(image("c_1.exr").planes, all.planes);
}

/// pbrt describes motion by transforms at two times.
TEST_F(Frames, OfPbrtFollowItsMotion) {
  folder_.write_text("ball.pbrt", R"(LookAt 0 0 5  0 0 0  0 1 0 Camera "perspective" "float fov" 60
Film "rgb" "integer xresolution" 24 "integer yresolution" 24
TransformTimes 0 1 WorldBegin LightSource "infinite"
Material "diffuse" "rgb reflectance" [ 0 1 0 ] ActiveTransform EndTime Translate -2 0 0 ActiveTransform All
Shape "trianglemesh" "point3 P" [ 0.5 -0.5 0 1.5 -0.5 0 1 0.5 0 ] "integer indices" [ 0 1 2 ])");
  const CommandResult result = run({"render", "ball.pbrt", "--frames", "0..1", "--fps", "1", "--shutter", "0", "--spp",
                                    "4", "-q", "-o", "b_#.exr", "--aov", "depth"});
  ASSERT_EQ(result.exit_code, 0) << result.everything();
  const auto column = [&](const std::string& name) {
    const Image seen = image(name);
    const std::vector<float>& depth = seen.planes.at(static_cast<size_t>(seen.channel("depth.Z")));
    double sum = 0, count = 0;
    for (size_t i = 0; i < depth.size(); ++i)
      if (depth[i] > 0) sum += static_cast<double>(i % 24), count += 1;
    return sum / count;
  };
  EXPECT_GT(std::abs(column("b_0.exr") - column("b_1.exr")), 5);
  const CommandResult still = render({"--frames", "0..1", "-o", "s_#.exr"});
  EXPECT_EQ(still.exit_code, 2);
  EXPECT_NE(still.err.find("nothing in the scene moves"), std::string::npos) << still.err;
}

}  // namespace

}  // namespace alhazen::impl::test

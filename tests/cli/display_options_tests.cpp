// Images for displays: the exposure and the white balance that an image decides on, the formats that are written, and
// what they say about themselves.

#include <algorithm>
#include <cmath>

#include "cli/fixture.h"

namespace alhazen::impl::test {

namespace {

class DisplayImages : public Command {
 protected:
  /// A box of these light and background in front of a camera that sees far more of the background.
  void write_subject(const std::string& name, const std::string& light, const std::string& background) const {
    folder_.write_text(
        name,
        "LookAt 0 0 9  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 30\n"
        "Film \"rgb\" \"integer xresolution\" 24 \"integer yresolution\" 24\n"
        "WorldBegin LightSource \"infinite\" \"rgb L\" [" +
            background +
            "]\n"
            "LightSource \"distant\" \"point3 from\" [0 0 5] \"rgb L\" [" +
            light +
            "]\n"
            "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5] Shape \"sphere\" \"float radius\" 1.1\n");
  }

  /// The object of --stats=json that says how PNG and JPEG were made.
  nlohmann::json display_of(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "render");
    arguments.insert(arguments.end(), {"--stats=json", "--progress", "none", "--spp", "4"});
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    return only_json(result.out).value("display", nlohmann::json());
  }

  /// Of the pixel in the middle of a PNG, decoded.
  double middle_of(const std::string& name) const {
    const Image png = image(name);
    return static_cast<double>(png.planes[1][static_cast<size_t>(png.width * (png.height / 2) + png.width / 2)]);
  }
};

TEST_F(DisplayImages, AutomaticExposureIsForTheSurfacesThatAreSeen) {
  // Denoised or with depth, the render knows where they are; without, the middle counts most.
  for (const std::vector<std::string>& how :
       {std::vector<std::string>{}, {"--aov", "depth", "-o", "layers.exr"}, {"--denoise", "builtin"}})
    for (const char* background : {"0 0 0", "0.01 0.01 0.01", "30 30 30"}) {
      write_subject("subject.pbrt", "4000 4000 4000", background);
      std::vector<std::string> arguments{"subject.pbrt", "-o", "a.png", "--exposure", "auto"};
      arguments.insert(arguments.end(), how.begin(), how.end());
      const nlohmann::json display = display_of(arguments);
      ASSERT_TRUE(display.is_object());
      EXPECT_TRUE(display["exposure_is_metered"]);
      EXPECT_GT(middle_of("a.png"), 0.1) << background;
      // 2000 / pi at the brightest: by 9.3 stops it would be just white.
      EXPECT_LT(display["exposure"], how.empty() ? -8.0 : -9.3) << background;
      if (how.empty()) continue;
      EXPECT_LT(middle_of("a.png"), 0.99) << background;
    }
}

TEST_F(DisplayImages, AutomaticExposureBrightensToo) {
  write_subject("dark.pbrt", "0.01 0.01 0.01", "0 0 0");
  const CommandResult result = run({"render", "dark.pbrt", "-o", "a.png", "--spp", "4", "--exposure", "auto"});
  ASSERT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_NE(result.err.find("exposure: auto chose +"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find(" EV\n"), std::string::npos) << result.err;
  EXPECT_GT(middle_of("a.png"), 0.1);
  // A number stays one, and without the option nothing is chosen.
  for (const std::vector<std::string>& given : {std::vector<std::string>{"--exposure", "-1.5"}, {}}) {
    std::vector<std::string> arguments{"dark.pbrt", "-o", "b.png"};
    arguments.insert(arguments.end(), given.begin(), given.end());
    const nlohmann::json display = display_of(arguments);
    EXPECT_EQ(display["exposure"], given.empty() ? 0 : -1.5);
    EXPECT_FALSE(display["exposure_is_metered"]);
  }
  EXPECT_TRUE(display_of({"dark.pbrt", "-o", "a.exr"}).is_null()) << "nothing is displayed";
}

TEST_F(DisplayImages, AutomaticExposureWorksForMeshes) {
  folder_.write_text(
      "mesh.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const nlohmann::json display = display_of({"mesh.ply", "-o", "a.png", "--exposure", "auto", "--light-scale", "1"});
  EXPECT_TRUE(display["exposure_is_metered"]);
}

/// The noise target is then of what is displayed at the metered exposure, whatever the brightness of the lights.
TEST_F(DisplayImages, NoiseIsMeasuredAtTheAutomaticExposure) {
  const auto reached = [&](const std::string& light) {
    write_subject("subject.pbrt", light, "0 0 0");
    const CommandResult result = run({"render", "subject.pbrt", "-o", "a.png", "--noise", "0.02,display", "--exposure",
                                      "auto", "--spp", "64", "--stats=json", "-q"});
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    return only_json(result.out)["noise"]["mean_spp"].get<double>();
  };
  EXPECT_NEAR(reached("1 1 1"), reached("1024 1024 1024"), 2);
}

TEST_F(DisplayImages, WhiteBalanceIsForDisplaysAlone) {
  write_subject("warm.pbrt", "6 3.2 1.2", "0 0 0");
  EXPECT_EQ(display_of({"warm.pbrt", "-o", "off.png", "-o", "off.exr", "--white-balance", "off"})["white_temperature"],
            0);
  const nlohmann::json given =
      display_of({"warm.pbrt", "-o", "cold.png", "-o", "cold.exr", "-o", "cold.hdr", "--white-balance", "3000"});
  EXPECT_EQ(given["white_temperature"], 3000);
  EXPECT_FALSE(given["white_is_estimated"]);
  EXPECT_EQ(image("off.exr").planes, image("cold.exr").planes);
  const auto blue_over_red = [&](const std::string& name) {
    const Image png = image(name);
    const size_t middle = static_cast<size_t>(png.width * (png.height / 2) + png.width / 2);
    return static_cast<double>(png.planes[2][middle] / png.planes[0][middle]);
  };
  EXPECT_LT(blue_over_red("off.png"), 0.4);
  EXPECT_GT(blue_over_red("cold.png"), 2 * blue_over_red("off.png"));
  EXPECT_NEAR(blue_over_red("cold.hdr"), blue_over_red("off.png"), 0.1);

  const CommandResult result =
      run({"render", "warm.pbrt", "-o", "auto.png", "--spp", "4", "--white-balance", "auto", "--exposure", "-2"});
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_NE(result.err.find("white balance: auto chose "), std::string::npos) << result.err;
  EXPECT_NE(result.err.find(" K\n"), std::string::npos) << result.err;
  EXPECT_NEAR(blue_over_red("auto.png"), 1, 0.3);
}

TEST_F(DisplayImages, WhatIsChosenIsNotSaidQuietly) {
  const CommandResult result =
      render({"-o", "a.png", "--spp", "1", "--exposure", "auto", "--white-balance", "auto", "-q"});
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_EQ(result.err, "");
}

TEST_F(DisplayImages, ToneMapsDiffer) {
  std::vector<std::vector<float>> seen;
  for (const char* map : {"none", "reinhard", "filmic", "aces", "agx"}) {
    ASSERT_EQ(render({"-o", "a.png", "--spp", "4", "--tone-map", map}).exit_code, 0) << map;
    const std::vector<float> green = image("a.png").planes[1];
    EXPECT_EQ(std::find(seen.begin(), seen.end(), green), seen.end()) << map;
    seen.push_back(green);
  }
}

TEST_F(DisplayImages, PngsOfSixteenBitsAreFiner) {
  ASSERT_EQ(render({"-o", "8.png", "--spp", "4", "--png-depth", "8"}).exit_code, 0);
  ASSERT_EQ(render({"-o", "16.png", "-o", "a.exr", "--spp", "4", "--exr-type", "float", "--png-depth", "16"}).exit_code,
            0);
  const auto largest_error = [&](const std::string& name) {
    const Image png = image(name), exr = image("a.exr");
    double largest = 0;
    for (size_t i = 0; i < png.planes[0].size(); ++i) {
      const double value = std::min(1.0, static_cast<double>(exr.planes[static_cast<size_t>(exr.channel("R"))][i]));
      largest = std::max(largest, std::abs(srgb_encode(static_cast<double>(png.planes[0][i])) - srgb_encode(value)));
    }
    return largest;
  };
  EXPECT_LT(largest_error("16.png"), 0.51 / 65535);
  EXPECT_GT(largest_error("8.png"), 0.2 / 255);
}

TEST_F(DisplayImages, EveryFormatIsWrittenByItsName) {
  const CommandResult result = render({"-o", "a.exr", "-o", "a.png", "-o", "a.jpg", "-o", "b.JPEG", "-o", "a.hdr", "-o",
                                       "a.pfm", "--spp", "4", "--jpeg-quality", "100"});
  ASSERT_EQ(result.exit_code, 0) << result.everything();
  const Image png = image("a.png"), pfm = image("a.pfm");
  for (const char* name : {"a.exr", "a.jpg", "b.JPEG", "a.hdr"}) {
    const Image other = image(name);
    const Image& reference = is_displayed_format(name) ? png : pfm;
    const std::vector<float>& green = other.planes[static_cast<size_t>(other.channel("G"))];
    for (size_t i = 0; i < green.size(); ++i)
      ASSERT_NEAR(green[i], reference.planes[1][i], 0.02f + 0.01f * reference.planes[1][i]) << name << i;
  }
  ASSERT_EQ(render({"-o", "small.jpg", "--spp", "4", "--jpeg-quality", "5"}).exit_code, 0);
  EXPECT_LT(read_file(folder_.file("small.jpg")).size(), read_file(folder_.file("a.jpg")).size());
}

TEST_F(DisplayImages, SayHowTheyWereMade) {
  for (const char* name : {"a.png", "a.jpg"}) {
    ASSERT_EQ(render({"-o", name, "--spp", "4", "--exposure", "0.5", "--white-balance", "5000", "--tone-map", "agx"})
                  .exit_code,
              0);
    const Bytes bytes = read_file(folder_.file(name));
    const std::string all(bytes.begin(), bytes.end());
    for (const char* text :
         {"Alhazen ", "scene.pbrt", "--max-depth", "--exposure 0.5 --white-balance 5000 --tone-map agx"})
      EXPECT_NE(all.find(text), std::string::npos) << name << " " << text;
    // Equal images are equal files: no time is in them.
    ASSERT_EQ(render({"-o", std::string("again_") + name, "--spp", "4", "--exposure", "0.5", "--white-balance", "5000",
                      "--tone-map", "agx"})
                  .exit_code,
              0);
    EXPECT_EQ(read_file(folder_.file(std::string("again_") + name)), bytes) << name;
  }
}

TEST_F(DisplayImages, AFullDiskLeavesTheOldFile) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
  for (const char* name : {"full.jpg", "full.hdr"}) {
    std::filesystem::create_symlink("/dev/full", folder_.file(name));
    const CommandResult result = render({"-o", name, "-o", "other.png", "--spp", "1"});
    EXPECT_EQ(result.exit_code, 1) << result.everything();
    EXPECT_NE(result.err.find(std::string("cannot write ") + name + ": No space left"), std::string::npos)
        << result.err;
    EXPECT_TRUE(exists("other.png")) << "others are written";
    std::filesystem::remove(folder_.file("other.png"));
  }
}

}  // namespace

}  // namespace alhazen::impl::test

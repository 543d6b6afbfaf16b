// Alpha, layers and the options of EXR at the command line; what the layers hold is tested in parity/layers_tests.cpp.

#include <ImfHeader.h>
#include <ImfMultiPartInputFile.h>
#include <ImfStringAttribute.h>
#include <ImfTileDescription.h>

#include <cmath>

#include "cli/fixture.h"
#include "images/read_scalar_texture.h"

namespace alhazen::impl::test {

namespace {

/// A ball over half of the image, under a sky.
class LayerOptions : public Command {
 protected:
  LayerOptions() {
    folder_.write_text("ball.pbrt",
                       "LookAt 0 0 9  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 30\n"
                       "Film \"rgb\" \"integer xresolution\" 40 \"integer yresolution\" 30\n"
                       "WorldBegin LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n"
                       "MakeNamedMaterial \"clay\" \"string type\" \"diffuse\" NamedMaterial \"clay\"\n"
                       "Shape \"sphere\" \"float radius\" 1.8\n");
  }

  CommandResult ball(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"render", "ball.pbrt", "--spp", "16", "--progress", "none"});
    return run(arguments);
  }

  static float at(const Image& image, const std::string& channel, int x, int y) {
    const int index = image.channel(channel);
    EXPECT_GE(index, 0) << channel;
    return index < 0 ? NAN : image.planes[static_cast<size_t>(index)][static_cast<size_t>(y * image.width + x)];
  }
};

TEST_F(LayerOptions, PngHasStraightAlphaAndExrPremultiplied) {
  ASSERT_EQ(ball({"--transparent-background", "-o", "a.exr", "-o", "a.png", "--exr-type", "float"}).exit_code, 0);
  const Image exr = image("a.exr");
  EXPECT_EQ(exr.channels, (std::vector<std::string>{"R", "G", "B", "A"}));
  const Image png = image("a.png");
  const ScalarTexture alpha = read_scalar_texture(folder_.file("a.png"), TextureEncoding::automatic);
  ASSERT_TRUE(alpha.from_alpha);
  const auto alpha_at = [&](int x, int y) {
    return static_cast<float>(alpha.texels.bytes[static_cast<size_t>(y * png.width + x)]) / 255;
  };
  int edges = 0;
  for (int y = 0; y < exr.height; ++y)
    for (int x = 0; x < exr.width; ++x) {
      const float a = at(exr, "A", x, y);
      EXPECT_NEAR(alpha_at(x, y), a, 0.003);
      edges += a > 0.1f && a < 0.9f;
      if (a > 0.1f) {
        EXPECT_NEAR(at(png, "R", x, y), at(exr, "R", x, y) / a, 0.02) << x << " " << y;
      } else if (a == 0) {
        EXPECT_EQ(at(exr, "R", x, y), 0);
      }
    }
  EXPECT_GT(edges, 10);
  EXPECT_EQ(at(exr, "A", 20, 15), 1);
  EXPECT_EQ(at(exr, "A", 0, 0), 0);
}

TEST_F(LayerOptions, EveryCompressionKeepsTheImage) {
  ASSERT_EQ(ball({"-o", "expected.exr", "--aov", "albedo"}).exit_code, 0);
  const Image expected = image("expected.exr");
  for (const char* compression : {"none", "rle", "zips", "zip", "piz", "dwaa", "dwab"}) {
    SCOPED_TRACE(compression);
    for (const char* tiles : {"0", "16"}) {
      ASSERT_EQ(
          ball({"-o", "a.exr", "--aov", "albedo", "--exr-compression", compression, "--exr-tiles", tiles}).exit_code,
          0);
      const Image a = image("a.exr");
      ASSERT_EQ(a.channels, expected.channels);
      const bool loses = std::string(compression).starts_with("dwa");
      for (size_t c = 0; c < a.planes.size(); ++c)
        for (size_t i = 0; i < a.planes[c].size(); ++i)
          EXPECT_NEAR(a.planes[c][i], expected.planes[c][i], loses ? 0.05 : 0) << c << " " << i;
    }
  }
}

TEST_F(LayerOptions, PartsHoldTheLayersAndTheirNames) {
  const std::vector<std::string> layers{"--aov", "depth,object,cryptomatte,normal", "--transparent-background"};
  std::vector<std::string> whole{"-o", "whole.exr"},
      parts{"-o", "parts.exr", "--exr-parts", "--exr-compression", "dwaa"};
  whole.insert(whole.end(), layers.begin(), layers.end());
  parts.insert(parts.end(), layers.begin(), layers.end());
  ASSERT_EQ(ball(whole).exit_code, 0);
  ASSERT_EQ(ball(parts).exit_code, 0);
  const Image a = image("whole.exr"), b = image("parts.exr");
  for (size_t c = 0; c < a.channels.size(); ++c) {
    const int there = b.channel(a.channels[c]);
    ASSERT_GE(there, 0) << a.channels[c];
    const bool is_colour = a.channels[c].size() == 1;  // of which DWAA loses a little
    for (size_t i = 0; i < a.planes[c].size(); ++i)
      EXPECT_NEAR(b.planes[static_cast<size_t>(there)][i], a.planes[c][i], is_colour ? 0.05 : 0) << a.channels[c];
  }
  const Imf::MultiPartInputFile file(folder_.file("parts.exr").c_str());
  std::vector<std::string> names;
  for (int i = 0; i < file.parts(); ++i) names.push_back(file.header(i).name());
  EXPECT_EQ(names, (std::vector<std::string>{"rgba", "normal", "depth", "object", "CryptoObject", "CryptoMaterial"}));
  const auto* objects = file.header(3).findTypedAttribute<Imf::StringAttribute>("object");
  ASSERT_NE(objects, nullptr);
  EXPECT_EQ(objects->value(), "{\"sphere.1\":1}");
  EXPECT_EQ(file.header(0).findTypedAttribute<Imf::StringAttribute>("object"), nullptr);
}

TEST_F(LayerOptions, TilesKeepTheCropsPlace) {
  for (const char* crop : {"0,1,0,1", "0.25,0.8,0.3,0.9"}) {
    ASSERT_EQ(ball({"-o", "lines.exr", "--crop", crop}).exit_code, 0);
    ASSERT_EQ(ball({"-o", "tiles.exr", "--crop", crop, "--exr-tiles", "8"}).exit_code, 0);
    EXPECT_EQ(image("lines.exr").planes, image("tiles.exr").planes) << crop;
    const Imf::MultiPartInputFile lines(folder_.file("lines.exr").c_str()), tiles(folder_.file("tiles.exr").c_str());
    EXPECT_EQ(lines.header(0).dataWindow(), tiles.header(0).dataWindow());
    ASSERT_TRUE(tiles.header(0).hasTileDescription());
    EXPECT_EQ(tiles.header(0).tileDescription().xSize, 8u);
  }
}

TEST_F(LayerOptions, BadOnesAreErrorsAndIdleOnesWarnings) {
  const auto error_of = [&](const std::vector<std::string>& arguments) {
    const CommandResult result = ball(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.everything();
    return result.err;
  };
  EXPECT_NE(error_of({"-o", "a.exr", "--exr-compression", "lzw"}).find("unknown compression 'lzw'"), std::string::npos);
  EXPECT_NE(error_of({"-o", "a.exr", "--exr-compression", "dwaa", "--aov", "depth"}).find("'depth', which is data"),
            std::string::npos);
  EXPECT_NE(error_of({"-o", "a.exr", "--exr-tiles", "3"}).find("from 8 to 1024"), std::string::npos);
  EXPECT_NE(error_of({"-o", "a.exr", "--aov", "colour"}).find("unknown layer 'colour'"), std::string::npos);
  EXPECT_NE(error_of({"-o", "a.exr", "--aov", "components", "--integrator", "iterative"}).find("need the integrator"),
            std::string::npos);
  EXPECT_NE(error_of({"-o", "a.exr", "--transparent-glass", "--integrator", "iterative"}).find("needs the integrator"),
            std::string::npos);
  EXPECT_NE(error_of({"-o", "a.exr", "--transparent-glass", "--guiding", "on"}).find("path guiding"),
            std::string::npos);
  EXPECT_FALSE(exists("a.exr"));
  const CommandResult idle =
      ball({"-o", "a.png", "--exr-tiles", "16", "--exr-parts", "--exr-compression", "piz", "--transparent-glass"});
  EXPECT_EQ(idle.exit_code, 0);
  for (const char* option : {"--exr-tiles", "--exr-parts", "--exr-compression", "--transparent-glass"})
    EXPECT_NE(idle.err.find(option + std::string(" has no effect")), std::string::npos) << option << "\n" << idle.err;
}

TEST_F(LayerOptions, LightGroupsAreLayers) {
  folder_.write_text("lit.pbrt",
                     "LookAt 0 0 9  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 30\n"
                     "Film \"rgb\" \"integer xresolution\" 20 \"integer yresolution\" 15\n"
                     "WorldBegin LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n"
                     "LightSource \"point\" \"point3 from\" [ 0 4 4 ] LightSource \"point\"\n"
                     "Shape \"sphere\" \"float radius\" 1.8\n");
  const auto lit = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"render", "lit.pbrt", "--spp", "4", "--progress", "none"});
    return run(arguments);
  };
  for (const bool in_parts : {false, true}) {
    std::vector<std::string> arguments{"-o", "a.exr", "--light-group", "sky=env*;key=point.1", "--exr-type", "float"};
    if (in_parts) arguments.push_back("--exr-parts");
    ASSERT_EQ(lit(arguments).exit_code, 0);
    const Image all = image("a.exr");
    for (const char* channel : {"light_sky.G", "light_key.G", "light_rest.G"}) EXPECT_GE(all.channel(channel), 0);
    EXPECT_NEAR(at(all, "light_sky.R", 0, 0), 1, 1e-5);
    EXPECT_EQ(at(all, "light_key.R", 0, 0), 0);
    EXPECT_GT(at(all, "light_key.R", 10, 5), 0);
    EXPECT_NEAR(at(all, "light_sky.R", 10, 7) + at(all, "light_key.R", 10, 7) + at(all, "light_rest.R", 10, 7),
                at(all, "R", 10, 7), 1e-5);
  }
  ASSERT_EQ(lit({"-o", "b.exr", "--aov", "light_groups"}).exit_code, 0);
  for (const char* channel : {"light_environment.R", "light_point_1.R", "light_point_2.R"})
    EXPECT_GE(image("b.exr").channel(channel), 0) << channel;

  const CommandResult wrong = lit({"-o", "c.exr", "--light-group", "key=sun"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.err.find("no light is called 'sun', which the light group 'key' names"), std::string::npos)
      << wrong.err;
  EXPECT_NE(lit({"-o", "c.exr", "--light-group", "key"}).err.find("must be NAME=LIGHT"), std::string::npos);
  EXPECT_FALSE(exists("c.exr"));
  const CommandResult idle = lit({"-o", "d.png", "--light-group", "key=point.1"});
  EXPECT_NE(idle.err.find("--light-group has no effect"), std::string::npos) << idle.err;

  std::string many = "key=point.1";
  for (int i = 0; i < 1000; ++i) many += ",point.2";
  ASSERT_EQ(lit({"--checkpoint", "long", "-o", "e.exr", "--light-group", many}).exit_code, 0);
  ASSERT_EQ(lit({"--checkpoint", "long", "--resume", "-o", "e.exr", "--light-group", many}).exit_code, 0);
  ASSERT_EQ(lit({"--checkpoint", "state", "-o", "e.exr", "--light-group", "key=point.1"}).exit_code, 0);
  const CommandResult other = lit({"--checkpoint", "state", "--resume", "-o", "e.exr", "--light-group", "key=point.2"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.err.find("light-group key=point.1"), std::string::npos) << other.err;
}

TEST_F(LayerOptions, MarksCheckpoints) {
  const std::vector<std::string> keeps{"--checkpoint", "state", "-o", "a.exr", "--transparent-background"};
  ASSERT_EQ(ball(keeps).exit_code, 0);
  const CommandResult other =
      run({"render", "ball.pbrt", "--spp", "32", "--checkpoint", "state", "--resume", "-o", "b.exr"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.err.find("transparent-background on"), std::string::npos) << other.err;
}

}  // namespace

}  // namespace alhazen::impl::test

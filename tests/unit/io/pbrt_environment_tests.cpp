// Infinite lights with images: reading, orientation, brightness, and errors.

#include <cmath>
#include <limits>

#include "core/lights/light.h"
#include "io/environment.h"
#include "support/environments.h"
#include "support/temporary_folder.h"
#include "unit/images/image_files.h"
#include "unit/io/pbrt_support.h"

namespace alhazen::impl::test {
namespace {

class PbrtEnvironment : public ::testing::Test {
 protected:
  PbrtEnvironment() {
    write("wide", even_map(8, 4, 2));
    write("square", even_map(4, 4, 0.5f));
    write("odd", even_map(3, 2, 1));
    write("dark", even_map(4, 4, 0));
    ImageTexels map = even_map(4, 4, 1);
    channel_of(map, 2, 1, 0) = std::numeric_limits<float>::infinity();
    write("endless", map);
    map = sun_map(16, 8, 5);
    channel_of(map, 0, 7, 2) = -3;
    write("sun", map);
    folder_.write_text("broken.exr", "not an image");
    folder_.write("grey.png", png(2, 1, 8, 2, {0, 0, 128, 255, 255, 128, 0}));
  }

  void write(const std::string& name, const ImageTexels& map) const {
    WriteOptions options;
    options.pixel_type = ExrPixelType::single;
    write_exr(folder_.file(name + ".exr"), source_of(image_of(map)), options);
  }

  Parsed infinite(const std::string& parameters, const std::string& before = {}) const {
    return parse_world(before + " LightSource \"infinite\" " + parameters, folder_.path());
  }

  /// The message for a light on the second line of a file.
  std::string error(const std::string& parameters) const {
    return error_of("WorldBegin\nLightSource \"infinite\" " + parameters, folder_.path());
  }

  TemporaryFolder folder_;
};

TEST_F(PbrtEnvironment, ImagesAreRead) {
  const Parsed p = infinite("\"string filename\" \"sun.exr\" \"float scale\" 3");
  EXPECT_TRUE(p.diagnostics.warnings().empty());
  const Light& light = p.scene.lights.at(0);
  EXPECT_EQ(light.kind, LightKind::environment);
  EXPECT_EQ(light.radiance, splat(3.0));
  EXPECT_EQ(light.where.line, 2);
  const ImageTexels& map = p.scene.environments.at(light.environment);
  ImageTexels expected = sun_map(16, 8, 5);
  channel_of(expected, 0, 7, 2) = 0;  // radiance cannot be negative
  EXPECT_EQ(map.width, 16);
  EXPECT_EQ(map.height, 8);
  EXPECT_EQ(map.floats, expected.floats);
}

TEST_F(PbrtEnvironment, BytesAreDecoded) {
  const Parsed p = infinite("\"string filename\" \"grey.png\"");
  const std::vector<float>& texels = p.scene.environments.at(0).floats;
  ASSERT_EQ(texels.size(), 6u);
  const float half = static_cast<float>(srgb_decode(128.0 / 255));
  EXPECT_EQ(texels, (std::vector<float>{0, half, 1, 1, half, 0}));
  EXPECT_NEAR(static_cast<double>(half), 0.2158605, 1e-6);
}

TEST_F(PbrtEnvironment, StandAsTheTransformSays) {
  const std::string file = "\"string filename\" \"wide.exr\"";
  Frame<double> axes = infinite(file, "Translate 5 6 7 Scale 3 3 3 Rotate 90 0 0 1").scene.lights.at(0).axes;
  expect_near(axes.tangent, {0, 1, 0});
  expect_near(axes.bitangent, {-1, 0, 0});
  expect_near(axes.normal, {0, 0, 1});
  axes = infinite(file, "Scale 1 -1 1 Rotate -90 1 0 0").scene.lights.at(0).axes;
  expect_near(axes.tangent, {1, 0, 0});
  expect_near(axes.bitangent, {0, 0, -1});
  expect_near(axes.normal, {0, -1, 0});
  const Parsed stretched = infinite(file, "Scale 1 2 -3");
  EXPECT_TRUE(stretched.warned("test.pbrt:2:")) << "with its place";
  EXPECT_TRUE(stretched.warned("stretches"));
  axes = stretched.scene.lights.at(0).axes;
  expect_near(axes.tangent, {1, 0, 0});
  expect_near(axes.bitangent, {0, 1, 0});
  expect_near(axes.normal, {0, 0, -1});
}

TEST_F(PbrtEnvironment, IlluminanceIsThatOfAPlaneThatFacesUp) {
  const Parsed even = infinite("\"string filename\" \"square.exr\" \"float illuminance\" 10");
  // Radiance 1/2 all around gives pi / 2.
  EXPECT_NEAR(even.scene.lights.at(0).radiance.x, 10 / (pi<double> / 2), 1e-3);
  for (const char* name : {"wide", "sun"}) {
    const Parsed p =
        infinite(std::string("\"float scale\" 2 \"float illuminance\" 10 \"string filename\" \"") + name + ".exr\"");
    ImageTexels map = p.scene.environments.at(0);
    const double scale = p.scene.lights.at(0).radiance.x;
    EXPECT_NEAR(scale * upward_irradiance(map), 20, 1e-9) << name;
  }
}

/// Fine maps, against irradiance in closed form.
TEST_F(PbrtEnvironment, IrradianceInClosedForm) {
  for (const int width : {256, 512}) {
    EXPECT_NEAR(upward_irradiance(even_map(width, 256, 1)), pi<double>, 1e-3);
    // Radiance cos^2 above the horizon, 7 below it: pi / 2.
    ImageTexels map = even_map(width, 256, 7);
    const SphereMapping mapping = width == 256 ? SphereMapping::octahedral : SphereMapping::equirectangular;
    for (int y = 0; y < 256; ++y)
      for (int x = 0; x < width; ++x) {
        const double z = direction_of_square(mapping, Vec2d{(x + 0.5) / width, (y + 0.5) / 256}).z;
        for (size_t c = 0; z > 0 && c < 3; ++c) channel_of(map, x, y, c) = static_cast<float>(z * z);
      }
    EXPECT_NEAR(upward_irradiance(map), pi<double> / 2, 2e-3);
  }
}

TEST_F(PbrtEnvironment, APortalIsNotUsed) {
  const Parsed p = infinite("\"string filename\" \"wide.exr\" \"point3 portal\" [ 0 0 0 1 0 0 1 1 0 0 1 0 ]");
  ASSERT_EQ(p.diagnostics.warnings().size(), 1u);
  EXPECT_TRUE(p.warned("portal"));
  EXPECT_EQ(p.scene.lights.at(0).kind, LightKind::environment);
}

TEST_F(PbrtEnvironment, SeveralInfiniteLightsStayThatMany) {
  const Parsed p = parse_world(
      "LightSource \"infinite\" \"string filename\" \"wide.exr\"\n"
      "LightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n"
      "LightSource \"infinite\" \"string filename\" \"square.exr\"",
      folder_.path());
  ASSERT_EQ(p.scene.lights.size(), 3u);
  EXPECT_EQ(p.scene.lights[0].environment, 0u);
  EXPECT_EQ(p.scene.lights[2].environment, 1u);
  const CompiledScene<float> flat = compiled_scene<float>(p.scene);
  expect_near(convert<double>(background_radiance(flat.view, Vec3f{0, 0, 1})), splat(3.5), 1e-6);
}

TEST_F(PbrtEnvironment, WhatIsRefused) {
  struct Refused {
    const char* parameters;
    const char* place;
    std::vector<const char*> words;
  };
  const Refused all[] = {
      {"\"string filename\" \"no.exr\"", "2:24", {"there is no file \"no.exr\""}},
      {"\"string filename\" \"odd.exr\"", "2:24", {"3 x 2", "twice as wide as high", "convert"}},
      {"\"string filename\" \"endless.exr\"", "2:24", {"infinite", "column 2, row 1"}},
      {"\"string filename\" \"wide.exr\" \"float scale\" -1", "2:53", {"scale"}},
      {"\"string filename\" \"dark.exr\" \"float illuminance\" 5", "2:53", {"black"}},
      {"\"string filename\" \"wide.exr\" \"float sale\" 1", "2:53", {"sale"}},
      {"\"string filename\" \"wide.exr\" \"rgb L\" [ 1 1 1 ]", "2:24", {"not both"}},
      {"\"string filename\" 3", "2:42", {"expected string"}},
      {"\"float filename\" 3", "2:24", {"filename"}},
  };
  for (const Refused& c : all) {
    SCOPED_TRACE(c.parameters);
    const std::string message = error(c.parameters), start = std::string("test.pbrt:") + c.place;
    EXPECT_EQ(message.substr(0, start.size()), start) << message;
    for (const char* word : c.words) EXPECT_NE(message.find(word), std::string::npos) << word << " in: " << message;
  }
  EXPECT_NE(error("\"string filename\" \"broken.exr\"").find("broken.exr"), std::string::npos);
}

TEST_F(PbrtEnvironment, BlackMapsAreNoLights) {
  const CompiledScene<float> flat = compiled_scene<float>(infinite("\"string filename\" \"dark.exr\"").scene);
  EXPECT_EQ(flat.view.lights_count, 0u);
  EXPECT_EQ(flat.view.environments_count, 0u);
}

/// Descriptions that were not made by a reader.
TEST_F(PbrtEnvironment, CompilingRefusesWhatIsNoMap) {
  const auto refuse = [](Scene scene) { EXPECT_THROW(compiled_scene<float>(std::move(scene)), InputError); };
  refuse(map_alone(even_map(3, 2, 1)));
  refuse(map_alone(even_map(0, 0, 1)));
  refuse(map_alone(even_map(4, 4, std::numeric_limits<float>::quiet_NaN())));
  ImageTexels cut = even_map(4, 4, 1);
  cut.floats.pop_back();
  refuse(map_alone(cut));
  Scene scene = map_alone(even_map(4, 4, 1));
  scene.environments.clear();
  refuse(scene);
}

}  // namespace
}  // namespace alhazen::impl::test

// Lights of pbrt scenes; those with images: reading, orientation, emission by direction, brightness, and errors.

#include <cmath>
#include <limits>

#include "core/lights/light.h"
#include "support/environments.h"
#include "support/temporary_folder.h"
#include "unit/io/pbrt_support.h"

namespace alhazen::impl::test {
namespace {

TEST(PbrtLights, Point) {
  const Parsed p = parse_world(
      "Translate 1 0 0 LightSource \"point\" \"point3 from\" [ 0 2 0 ] \"rgb I\" [ 1 2 3 ] "
      "\"float scale\" 2 \"float power\" 10");
  const Light& light = p.scene.lights.at(0);
  EXPECT_EQ(light.kind, LightKind::point);
  expect_near(light.position, {1, 2, 0});
  expect_near(light.radiance, Vec3d{2, 4, 6} * (10 / (4 * pi<double>)));
  EXPECT_EQ(light.where.line, 2);
}

TEST(PbrtLights, DistantWithAnAngleIsASun) {
  const Parsed p = parse_world(
      "LightSource \"distant\" \"rgb L\" [ 1 2 3 ] \"float angle\" 0.5 LightSource \"distant\" \"float angle\" 0");
  EXPECT_EQ(p.scene.lights[0].kind, LightKind::sun);
  EXPECT_EQ(p.scene.lights[0].cone_angle, 0.25);
  expect_near(p.scene.lights[0].radiance, {1, 2, 3});
  EXPECT_EQ(p.scene.lights[1].kind, LightKind::distant);
  for (const char* angle : {"-1", "0.001", "181"})
    EXPECT_NE(error_of(std::string("WorldBegin LightSource \"distant\" \"float angle\" ") + angle).find("0.01 to 180"),
              std::string::npos)
        << angle;
}

TEST(PbrtLights, DistantTravelsFromFromToTo) {
  const Parsed p = parse_world(
      "Rotate 90 1 0 0 LightSource \"distant\" LightSource \"distant\" "
      "\"point3 from\" [ 0 5 0 ] \"point3 to\" [ 0 1 0 ] \"float illuminance\" 3");
  expect_near(p.scene.lights[0].direction, {0, -1, 0});
  expect_near(p.scene.lights[0].radiance, {1, 1, 1});
  expect_near(p.scene.lights[1].direction, {0, 0, -1});
  expect_near(p.scene.lights[1].radiance, {3, 3, 3});
}

TEST(PbrtLights, Spot) {
  const Parsed p = parse_world(
      "LightSource \"spot\" \"point3 from\" [ 0 0 5 ] \"point3 to\" [ 0 0 1 ] "
      "\"float coneangle\" 40 \"float conedeltaangle\" 10 \"float power\" 1");
  const Light& light = p.scene.lights.at(0);
  EXPECT_EQ(light.kind, LightKind::spot);
  expect_near(light.direction, {0, 0, -1});
  EXPECT_EQ(light.cone_angle, 40);
  EXPECT_EQ(light.falloff_start, 30);
  const double start = std::cos(pi<double> / 6), end = std::cos(40 * pi<double> / 180);
  expect_near(light.radiance, splat(1 / (2 * pi<double> * (1 - (start + end) / 2))), 1e-12);
}

TEST(PbrtLights, Infinite) {
  const Parsed p = parse_world(
      "LightSource \"infinite\" \"rgb L\" [ 1 2 3 ] \"float scale\" 2\n"
      "LightSource \"infinite\" \"float illuminance\" 10");
  EXPECT_EQ(p.scene.lights[0].kind, LightKind::constant_infinite);
  expect_near(p.scene.lights[0].radiance, {2, 4, 6});
  expect_near(p.scene.lights[1].radiance, splat(10 / pi<double>));
}

class PbrtLightImages : public ::testing::Test {
 protected:
  PbrtLightImages() {
    // Bright only at the right of the top row.
    ImageTexels map = even_map(4, 2, 0);
    for (size_t c = 0; c < 3; ++c) channel_of(map, 3, 0, c) = 1 + static_cast<float>(c);
    write("corner", map);
    // The inner diamond of a square map is the hemisphere about its z.
    map = even_map(16, 16, 0);
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x)
        if (direction_of_octahedral(Vec2d{(x + 0.5) / 16, (y + 0.5) / 16}).z > 0)
          channel_of(map, x, y, 0) = channel_of(map, x, y, 1) = 3;
    write("upper", map);
    write("dark", even_map(4, 4, 0));
    write("even", even_map(4, 4, 2));
    map = even_map(4, 4, 1);
    channel_of(map, 2, 1, 0) = std::numeric_limits<float>::infinity();
    write("endless", map);
  }

  void write(const std::string& name, const ImageTexels& map) const {
    WriteOptions options;
    options.pixel_type = ExrPixelType::single;
    write_exr(folder_.file(name + ".exr"), source_of(image_of(map)), options);
  }

  Parsed world(const std::string& text) const { return parse_world(text, folder_.path()); }
  std::string error(const std::string& text) const { return error_of("WorldBegin\n" + text, folder_.path()); }

  /// Radiance that the only light sends to `point`.
  Vec3d sent_to(const std::string& text, const Vec3d& point) const {
    const CompiledScene<double> scene = compiled_scene<double>(world(text).scene);
    EXPECT_EQ(scene.view.lights_count, 1u);
    return sample_light(scene.view, point, Vec3d{}, 0.0, Vec2d{0.5, 0.5}).radiance;
  }

  TemporaryFolder folder_;
};

TEST_F(PbrtLightImages, AProjectionStandsUpright) {
  const std::string light = R"(LightSource "projection" "string filename" "corner.exr" "float fov" 90 "float scale" 2)";
  const Parsed p = world(light);
  EXPECT_TRUE(p.diagnostics.warnings().empty());
  EXPECT_EQ(p.scene.lights[0].kind, LightKind::projection);
  // Twice as wide as high: at distance 1 from -2 to 2 and from -1 to 1. The texel's centre is (1.5, 0.5); x is to the
  // right when looking along z with y up.
  expect_near(sent_to(light, {1.5, 0.5, 1}), Vec3d{2, 4, 6} / splat(3.5), 1e-9);
  for (const Vec3d& dark : {Vec3d{-1.5, 0.5, 1}, {1.5, -0.5, 1}, {2.1, 0.5, 1}, {1.5, 1.1, 1}, {-1.5, -0.5, -1}})
    EXPECT_TRUE(is_zero(sent_to(light, dark))) << dark.x << " " << dark.y << " " << dark.z;
  expect_near(sent_to("Translate 1 2 3 " + light, {2.5, 2.5, 4}), Vec3d{2, 4, 6} / splat(3.5), 1e-9);
  expect_near(sent_to("Rotate 90 0 1 0 " + light, {1, 0.5, -1.5}), Vec3d{2, 4, 6} / splat(3.5), 1e-9);
}

TEST_F(PbrtLightImages, AGoniometricLightStandsUpright) {
  const std::string light = R"(LightSource "goniometric" "string filename" "upper.exr" "rgb I" [ 5 6 7 ])";
  const Parsed p = world(light);
  EXPECT_TRUE(p.diagnostics.warnings().empty());
  EXPECT_EQ(p.scene.lights[0].kind, LightKind::goniometric);
  // The image's z is the light's y; red and green of 3 have the mean 2 over the channels.
  expect_near(sent_to(light, {0, 2, 0}), Vec3d{10, 12, 14} / splat(4.0), 1e-6);
  EXPECT_TRUE(is_zero(sent_to(light, {0, -2, 0})));
  EXPECT_TRUE(is_zero(sent_to("Rotate 180 1 0 0 " + light, {0, 2, 0})));
  EXPECT_TRUE(world("LightSource \"goniometric\" \"rgb I\" [ 1 1 1 ]").warned("equally in all directions"));
}

/// The integral of the emission over the sphere is the power.
TEST_F(PbrtLightImages, PowerIsAllThatIsSent) {
  for (const std::string light :
       {R"(LightSource "goniometric" "string filename" "upper.exr" "float power" 10)",
        R"(LightSource "projection" "string filename" "corner.exr" "float power" 10 "float fov" 60)",
        R"(LightSource "projection" "string filename" "even.exr" "float power" 10 "float fov" 20)"}) {
    const CompiledScene<double> scene = compiled_scene<double>(world(light).scene);
    const double sent = integral_over_sphere(600, [&](const Vec3d& d) {
      return luminance(sample_light(scene.view, d, Vec3d{}, 0.0, Vec2d{0.5, 0.5}).radiance);
    });
    // In an image of few texels, interpolation moves light to texels with other weights.
    EXPECT_NEAR(sent, 10, light.find("even") != std::string::npos ? 0.1 : 0.6) << light;
  }
}

TEST_F(PbrtLightImages, OfAreaLights) {
  const std::string quad =
      R"( Shape "trianglemesh" "point3 P" [ 0 0 0  4 0 0  4 2 0  0 2 0 ] "integer indices" [ 0 1 2 0 2 3 ]
          "point2 uv" [ 0 0  1 0  1 1  0 1 ])";
  const std::string light = R"(AreaLightSource "diffuse" "string filename" "corner.exr" "float scale" 3)";
  const Parsed p = world(light + quad);
  EXPECT_TRUE(p.diagnostics.warnings().empty());
  const CompiledScene<double> scene = compiled_scene<double>(p.scene);
  const Hit<double> hit{1, 0, 0, PrimitiveId(PrimitiveKind::triangle, 0)};
  // The centre of the last texel of the top row is at (3.5, 1.5); v points up in the image.
  SurfaceInteraction<double> si = surface_interaction(scene.view, Ray<double>{{0, 0, 1}, {0, 0, -1}, 0}, hit);
  const LightRecord<double>& lamp = scene.view.lights[0];
  si.uv = {3.5 / 4, 1.5 / 2};
  expect_near(convert<double>(lamp.radiance * emission_factor(scene.view, lamp, point_of_emission(si, hit))), {3, 6, 9},
              1e-6);
  si.uv = {3.5 / 4, 0.5 / 2};
  EXPECT_TRUE(is_zero(emission_factor(scene.view, lamp, point_of_emission(si, hit))));
  // Light sampling and BSDF sampling see the same emission.
  for (const Vec2d& u : {Vec2d{0.1, 0.2}, {0.7, 0.9}, {0.95, 0.4}}) {
    const LightSample<double> s = sample_light(scene.view, Vec3d{1, 1, 5}, Vec3d{}, 0.0, u);
    si.uv = {s.point.x / 4, s.point.y / 2};
    expect_near(s.radiance, emission_factor(scene.view, lamp, point_of_emission(si, hit)) * 3, 1e-6);
  }
  // pi times the area times the mean luminance of the image is the power.
  const Parsed powered = world(R"(AreaLightSource "diffuse" "string filename" "even.exr" "float power" 10)" + quad);
  EXPECT_NEAR(shapes(powered)[0].emission->radiance.x, 10 / (pi<double> * 8 * 2), 1e-9);
}

TEST_F(PbrtLightImages, Errors) {
  const std::string goniometric = "LightSource \"goniometric\" \"string filename\" ";
  const std::string projection = "LightSource \"projection\" ";
  struct Case {
    std::string text, place, message;
  };
  for (const Case& c :
       {Case{goniometric + "\"no.exr\"", "2:27", "there is no file"},
        {goniometric + "\"corner.exr\"", "2:27", "square"},
        {goniometric + "\"endless.exr\"", "2:27", "infinite"},
        {goniometric + "\"dark.exr\" \"float power\" 3", "2:56", "black"},
        {projection, "2:1", "filename"},
        {projection + "\"string filename\" \"even.exr\" \"float fov\" 180", "2:55", "fov"},
        {"AreaLightSource \"diffuse\" \"string filename\" \"no.exr\"", "2:27", "there is no file"},
        {"AreaLightSource \"diffuse\" \"string filename\" \"dark.exr\" \"float power\" 1", "2:27", "black"}}) {
    const std::string message = error(c.text);
    EXPECT_NE(message.find("test.pbrt:" + c.place + ":"), std::string::npos) << message;
    EXPECT_NE(message.find(c.message), std::string::npos) << message;
  }
  EXPECT_NE(error_of("Integrator \"path\" \"string lightsampler\" \"none\"").find("unknown light sampler"),
            std::string::npos);
}

}  // namespace
}  // namespace alhazen::impl::test

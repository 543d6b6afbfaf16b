// What programs do wrong: an InputError that names it, never a crash.

#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "alhazen/rays.h"
#include "alhazen/renderer.h"
#include "alhazen/save.h"
#include "scene_support.h"

namespace alhazen::test {

namespace {

TEST(Misuse, OfAMovedFromRenderer) {
  Scene scene;
  Renderer renderer(quick_settings());
  Renderer other = std::move(renderer);
  const std::string message = "the renderer was moved from: assign another to it first";
  EXPECT_EQ(error_of([&] { renderer.settings(); }), message);
  EXPECT_EQ(error_of([&] { renderer.set_settings({}); }), message);
  EXPECT_EQ(error_of([&] { renderer.start(scene); }), message);
  EXPECT_EQ(error_of([&] { renderer.render_pass(); }), message);
  EXPECT_EQ(error_of([&] { renderer.image(); }), message);
  EXPECT_EQ(error_of([&] { renderer.progress(); }), message);
  EXPECT_EQ(error_of([&] { renderer.finish(); }), message);
  EXPECT_EQ(error_of([&] { renderer.render(scene); }), message);
  EXPECT_EQ(error_of([&] { renderer.warnings(); }), message);
  renderer.stop();
  renderer = std::move(other);
  EXPECT_EQ(renderer.settings().width, quick_settings().width);
}

TEST(Misuse, MovingARendererAwayBetweenPasses) {
  Scene scene;
  scene.add(alhazen::Shape{Sphere{1}, {}});
  Settings settings = quick_settings();
  settings.samples_per_pixel = 4096;  // not all in the first pass
  Renderer renderer(settings);
  Renderer other;
  EXPECT_EQ(error_of([&] {
              renderer.render(scene, {}, [&](const Renderer&) {
                other = std::move(renderer);
                return true;
              });
            }),
            "the renderer was moved from: assign another to it first");
}

TEST(Misuse, OfNullPointers) {
  EXPECT_EQ(error_of([] { RayQueries(std::shared_ptr<const impl::QueryScene>()); }), "'scene' must not be null");
  RenderedImage image;
  image.channels = {"R"};
  EXPECT_EQ(image.plane("R"), nullptr);
}

TEST(Misuse, OfTexturesThatAreNotThere) {
  Scene scene;
  const TextureId none = scene.find_texture("typo");
  EXPECT_EQ(error_of([&] { scene.add(Principled{.base_colour = none}); }),
            "'base_colour' is a handle that names nothing");
  EXPECT_EQ(error_of([&] { scene.add(Principled{.metallic = none}); }), "'metallic' is a handle that names nothing");
  EXPECT_EQ(error_of([&] { scene.add(Conductor{.reflectance = none}); }),
            "'reflectance' is a handle that names nothing");
  EXPECT_EQ(error_of([&] { scene.add(CheckerboardTexture{.even = none}); }), "'even' is a handle that names nothing");
  EXPECT_TRUE(scene.materials().empty());
  EXPECT_TRUE(scene.textures().empty());
  Material material{Diffuse{}};
  material.normal_map = none;  // there is no such map
  scene.add(material);
}

TEST(Misuse, OfSave) {
  RenderedImage image;
  image.width = image.height = 1;
  image.channels = {"R", "G", "B"};
  image.planes.assign(3, {0.5f});
  SaveOptions options;
  options.tone_mapping = static_cast<ToneMapping>(44);
  EXPECT_EQ(error_of([&] { encode_png(image, options); }), "tone_mapping is none of its values");
  for (const double exposure : {1e6, -1e6, std::numeric_limits<double>::quiet_NaN()}) {
    options = {};
    options.exposure = exposure;
    EXPECT_EQ(error_of([&] { encode_png(image, options); }), "exposure must be from -126 to 127 stops");
  }
  image.channels = {"R", "R", "B"};
  EXPECT_EQ(error_of([&] { encode_png(image); }), "'channels' has 'R' twice");
  image.channels = {"R", "", "B"};
  EXPECT_EQ(error_of([&] { encode_png(image); }), "'channels' has an empty name");
}

TEST(Misuse, OfShapesThatReachTooFar) {
  Scene scene;
  const std::string rest = " reaches farther than 1e18, which is too far for ray tracing: scale the scene down";
  EXPECT_EQ(error_of([&] { scene.add(alhazen::Shape{Sphere{1e300}, {}}); }), "'radius'" + rest);
  const Transform far = Transform::translate({1e19, 0, 0});
  EXPECT_EQ(error_of([&] { scene.add(alhazen::Shape{Sphere{1}, {}, far}); }), "'transform'" + rest);
  const ShapeId shape = scene.add(alhazen::Shape{Sphere{1}, {}});
  EXPECT_EQ(error_of([&] { scene.set_transform(shape, far); }), "'world_from_object'" + rest);
  EXPECT_EQ(error_of([&] { scene.set(shape, alhazen::Shape{Sphere{1e300}, {}}); }), "'radius'" + rest);
  EXPECT_EQ(scene.shapes().size(), 1u);
  scene.orbit(30, 20);
}

TEST(Misuse, OfCoordinatesThatAreTooFarForDoublePrecision) {
  for (const double far : {1e5, 1e12, 1e16}) {
    Scene scene;
    scene.add(alhazen::Shape{Sphere{1}, {}, Transform::translate({far, far, -far})});
    const RenderedImage image = render(scene, quick_settings());
    EXPECT_EQ(image.warnings.size(), far == 1e16 ? 1u : 0u) << far;
    for (const Warning& warning : image.warnings)
      EXPECT_NE(warning.message.find("far from the origin"), std::string::npos);
  }
}

}  // namespace

}  // namespace alhazen::test

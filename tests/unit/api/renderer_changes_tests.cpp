// What a Renderer builds anew after a change, and that its images are those of render() whatever changed before.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "alhazen/renderer.h"
#include "render/backend.h"

namespace alhazen {

namespace {

/// Gives a scene an environment map.
LightId set_sky(Scene& scene, int height, float peak) {
  std::vector<float> texels;
  for (int i = 0; i < 6 * height * height; ++i) texels.push_back(i % 11 == 0 ? peak : 0.2f);
  return scene.set_environment(Pixels{.width = 2 * height, .height = height, .channels = 3, .floats = texels});
}

/// A scene with parts of each kind. Its group is an object if there are many copies of it.
struct Stage {
  explicit Stage(int copies = 3) {
    const std::vector<float> positions{-3, 0, -3, 3, 0, -3, 3, 0, 3, -3, 0, 3};
    const std::vector<float> corner{0, 0, 0, 0.5f, 0, 0, 0, 0.5f, 0, 0, 0, 0.5f};
    const std::vector<uint32_t> quad{0, 2, 1, 0, 3, 2}, tetrahedron{0, 2, 1, 0, 3, 2, 0, 1, 3, 1, 2, 3};
    clay = scene.add(Diffuse{.reflectance = Colour{0.7, 0.2, 0.1}});
    const MeshId plane = scene.add(MeshArrays{.positions = positions, .indices = quad});
    pyramid = scene.add(MeshArrays{.positions = corner, .indices = tetrahedron});
    floor = scene.add(Shape{plane, clay});
    ball = scene.add(Shape{Sphere{0.4}, scene.add(Dielectric{}), Transform::translate({-1, 0.4, 0})});
    block = scene.add(Shape{pyramid, clay, Transform::translate({1, 0, 1})});
    lamp = scene.add(Shape{plane,
                           {},
                           Transform::translate({0, 3, 0}) * Transform::rotate(180, {1, 0, 0}) * Transform::scale(0.1),
                           Emission{.radiance = 8}});
    group = scene.add_group("pyramid");
    scene.add(Shape{pyramid, clay}, group);
    for (int i = 0; i < copies; ++i)
      instances.push_back(scene.add(Instance{group, Transform::translate({0.9 * i - 1, 0.1, -1})}));
    bulb = scene.add(PointLight{{3, 3, 2}, {1, 2, 2}});
    sun = scene.add(DistantLight{.irradiance = 0.5, .direction = {0.2, -1, -0.3}});
    environment = set_sky(scene, 8, 2);
    scene.look_at({1, 2, 5}, {0, 0.3, 0});
    alhazen::Film film = scene.film();
    film.width = 16, film.height = 12;
    scene.set_film(film);
  }

  Scene scene;
  MaterialId clay;
  MeshId pyramid;
  ShapeId floor, ball, block, lamp;
  GroupId group;
  std::vector<InstanceId> instances;
  LightId bulb, sun, environment;
};

Settings settings_for(const std::string& backend = "serial", const std::string& precision = "float") {
  Settings settings;
  settings.samples_per_pixel = 4;
  settings.max_depth = 4;
  settings.backend = backend;
  settings.precision = precision;
  if (backend == "cuda") settings.device = "host";
  return settings;
}

void expect_equal(const RenderedImage& a, const RenderedImage& b) {
  EXPECT_EQ(a.channels, b.channels);
  EXPECT_EQ(a.planes, b.planes);
  EXPECT_EQ(a.warnings, b.warnings);
}

/// The parts that were built, as text.
std::string parts_of(const BuildReport& report) {
  if (report.is_new) return "everything";
  std::string parts;
  const auto add = [&](bool is_built, const char* name) {
    if (is_built) parts += (parts.empty() ? "" : " ") + std::string(name);
  };
  add(report.materials, "materials");
  add(report.lights, "lights");
  add(report.environment, "environment");
  add(report.transforms, "transforms");
  return parts;
}

/// A renderer, and what it is expected to build.
struct Checked {
  explicit Checked(const Settings& settings) : renderer(settings) {}

  void expect(const Scene& scene, const std::string& parts, const char* what) {
    SCOPED_TRACE(what);
    EXPECT_EQ(parts_of(renderer.start(scene)), parts);
    while (renderer.render_pass()) {
    }
    expect_equal(renderer.finish(), render(scene, renderer.settings()));
  }

  Renderer renderer;
};

class RendererChanges : public ::testing::TestWithParam<std::string> {
 protected:
  /// Those of the backend called by the parameter, `NAME PRECISION`; skips the test where it is not there.
  Settings settings() {
    const std::string text = GetParam(), backend = text.substr(0, text.find(' '));
    if (backend != "cuda" && !impl::make_backend(backend)->status().available) skips = true;
    return settings_for(backend, text.substr(text.find(' ') + 1));
  }

  bool skips = false;
};

INSTANTIATE_TEST_SUITE_P(Backends, RendererChanges,
                         ::testing::Values("serial float", "serial double", "openmp float", "openmp double",
                                           "embree float", "cuda float", "cuda double"),
                         [](const auto& backend) {
                           std::string name = backend.param;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

TEST_P(RendererChanges, BuildsOnlyTheirParts) {
  const Settings settings = this->settings();
  if (skips) GTEST_SKIP() << "the backend is not there";
  Stage stage;
  Scene& scene = stage.scene;
  Checked checked(settings);
  checked.expect(scene, "everything", "the first image");
  checked.expect(scene, "", "nothing");
  scene.look_at({-2, 1, 4}, {0, 0.2, 0});
  checked.expect(scene, "", "the camera");
  scene.set(stage.clay, Diffuse{.reflectance = Colour{0.1, 0.5, 0.6}});
  checked.expect(scene, "materials", "a colour");
  scene.set(stage.bulb, PointLight{{9, 1, 1}, {1, 2, 2}});
  checked.expect(scene, "lights", "the intensity of a light");
  scene.set(stage.bulb, SpotLight{.intensity = 20, .position = {-1, 3, 1}, .direction = {0.2, -1, 0}});
  checked.expect(scene, "lights", "its kind");
  const LightId more = scene.add(PointLight{4, {-2, 1, 1}});
  checked.expect(scene, "lights", "another light");
  scene.remove(more);
  checked.expect(scene, "lights", "one less");
  Shape lamp = scene.shape(stage.lamp);
  lamp.emission->radiance = {1, 20, 5};
  scene.set(stage.lamp, lamp);
  checked.expect(scene, "lights", "the radiance of a shape");
  scene.set(stage.environment, EnvironmentLight{.scale = {2, 1, 0.5}});
  checked.expect(scene, "lights", "the brightness of the environment");
  set_sky(scene, 12, 7);
  checked.expect(scene, "lights environment", "another map");
  scene.set_environment(Colour{0.2, 0.3, 0.5});
  checked.expect(scene, "lights environment", "a constant environment");
  scene.set_transform(stage.instances[1], Transform::translate({0, 0.5, 0.5}) * Transform::rotate(40, {1, 1, 0}));
  checked.expect(scene, "transforms", "an instance");
  scene.set_transform(stage.block, Transform::translate({0.3, 0, 1.2}) * Transform::scale(1.5));
  checked.expect(scene, "transforms", "a mesh of the world");
  scene.set_transform(stage.ball, Transform::translate({0.5, 0.5, 1}));
  checked.expect(scene, "transforms", "a sphere");
  scene.set_transform(stage.lamp,
                      Transform::translate({1, 2, 0}) * Transform::rotate(120, {1, 0, 0}) * Transform::scale(0.2));
  checked.expect(scene, "transforms", "a light with a shape");
  scene.set(stage.clay, CoatedDiffuse{.reflectance = Colour{0.3, 0.3, 0.1}});
  scene.set(stage.sun, DistantLight{.irradiance = 2, .direction = {1, -1, 0}});
  scene.set_transform(stage.instances[0], Transform::translate({1, 0.1, 2}));
  scene.look_at({2, 3, 4}, {0, 0, 0});
  checked.expect(scene, "materials lights transforms", "several at once");
}

TEST_P(RendererChanges, TakesSettingsOfLightsAndCamera) {
  Settings settings = this->settings();
  if (skips) GTEST_SKIP() << "the backend is not there";
  Stage stage;
  Checked checked(settings);
  checked.expect(stage.scene, "everything", "the first image");
  const auto expect = [&](const std::string& parts, const char* what) {
    checked.renderer.set_settings(settings);
    checked.expect(stage.scene, parts, what);
  };
  settings.environment_rotation = 70;
  expect("lights", "a turned environment");
  settings.environment_strength = 0.3;
  expect("lights", "a weaker one");
  settings.light_scale = 2;
  expect("lights", "brighter lights");
  settings.look_at = {0, 3, 3, 0, 0, 0};
  expect("", "a camera");
  settings.look_at = {};
  settings.orbit = {40, 20};
  settings.fov = 50;
  expect("", "a camera that sees all");
  settings.aperture = 0.1;
  settings.width = 20, settings.height = 10;
  expect("", "its lens, and a wider image");
  stage.scene.set_transform(stage.instances[0], Transform::translate({2, 0.1, 0}));
  expect("transforms", "an instance in a view of all");
  settings.max_depth = 2;
  expect("", "another depth");
}

/// Random changes one after the other, of a group that is copied into the world, and of one that is an object since it
/// moves.
TEST_P(RendererChanges, GivesTheImagesOfRenderAfterAnySequence) {
  const Settings settings = this->settings();
  if (skips) GTEST_SKIP() << "the backend is not there";
  for (const bool has_motion : {false, true}) {
    Stage stage;
    Scene& scene = stage.scene;
    if (has_motion)
      scene.set_transform(stage.instances[2], {Transform::translate({0, 1, 0}), Transform::translate({0.3, 1.2, 0})});
    std::mt19937 random(has_motion ? 7 : 3);
    const auto number = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    const auto index = [&](size_t count) { return std::uniform_int_distribution<size_t>(0, count - 1)(random); };
    const auto place = [&] {
      return Transform::translate({number(-2, 2), number(0, 1), number(-2, 2)}) *
             Transform::rotate(number(0, 360), {number(-1, 1), 1, number(-1, 1)});
    };
    Renderer renderer(settings);
    EXPECT_TRUE(renderer.start(scene).is_new);
    const auto change_any = [&] {
      switch (index(9)) {
        case 0:
          return scene.look_at({number(-3, 3), number(1, 3), 5}, {0, 0, 0});
        case 1:
          return scene.set(stage.clay, Diffuse{.reflectance = Colour{number(0, 1), number(0, 1), 0.5}});
        case 2:
          return scene.set(stage.bulb, PointLight{number(0, 9), {number(-1, 1), 2, number(-1, 1)}});
        case 3: {
          Shape lamp = scene.shape(stage.lamp);
          lamp.emission->radiance = number(1, 9);
          return scene.set(stage.lamp, lamp);
        }
        case 4:
          stage.environment = set_sky(scene, static_cast<int>(4 + index(4)), 3);
          return;
        case 5:
          return scene.set_transform(stage.block, place());
        case 6:
          return scene.set_transform(stage.lamp, place() * Transform::scale(0.2));
        default:
          return scene.set_transform(stage.instances[index(2)], place());
      }
    };
    for (int i = 0; i < 12; ++i) {
      SCOPED_TRACE(i);
      for (size_t k = 1 + index(3); k > 0; --k) change_any();
      EXPECT_FALSE(renderer.start(scene).is_new);
      while (renderer.render_pass()) {
      }
      expect_equal(renderer.finish(), render(scene, settings));
    }
  }
}

TEST(RendererChangesOf, ThousandsOfInstancesThatAreAnObject) {
  Stage stage(40'000);  // more triangles than are copied
  Scene& scene = stage.scene;
  Checked checked(settings_for("openmp"));
  checked.expect(scene, "everything", "the first image");
  scene.set_transform(stage.instances[5], Transform::translate({0, 0.4, 1}));
  checked.expect(scene, "transforms", "one of them");
  for (size_t i = 0; i < 1000; ++i)
    scene.set_transform(stage.instances[i], Transform::translate({0.001 * static_cast<double>(i), 0.4, 1}));
  checked.expect(scene, "transforms", "a thousand of them");
  scene.set(stage.bulb, PointLight{1, {0, 1, 1}});
  checked.expect(scene, "lights", "a light");
}

TEST(RendererChangesOf, WhatIsBuiltAsAWhole) {
  Stage stage;
  Scene& scene = stage.scene;
  Checked checked(settings_for());
  checked.expect(scene, "everything", "the first image");
  scene.set_transform(stage.instances[0], {Transform(), Transform::translate({0.2, 0, 0})});
  checked.expect(scene, "everything", "an instance of a group of which none moved before");
  scene.set_transform(stage.instances[0], {Transform(), Transform::translate({0, 0.4, 0})});
  checked.expect(scene, "transforms", "another motion");
  scene.set_transform(stage.ball, Transform::scale({1, 2, 1}));
  checked.expect(scene, "everything", "a sphere that becomes a mesh");
  Shape lamp = scene.shape(stage.lamp);
  lamp.emission->radiance = 0;
  scene.set(stage.lamp, lamp);
  checked.expect(scene, "everything", "a shape that ceases to emit");
  scene.set_positions(stage.pyramid, std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
  checked.expect(scene, "everything", "positions");
  scene.remove(stage.instances[0]);
  checked.expect(scene, "everything", "a part that is removed");
  scene.set_transform(stage.block, Transform::translate({1e7, 0, 0}));
  scene.set_transform(stage.floor, Transform::translate({1e7, 0, 0}));
  scene.look_at({1e7, 2, 5}, {1e7, 0, 0});
  checked.expect(scene, "everything", "another render space");
  scene.set(stage.bulb, PointLight{1, {1e7, 1, 1}});
  checked.expect(scene, "everything", "a light there");
}

TEST(RendererChangesOf, LightsWithGroupsAndNames) {
  Stage stage;
  Scene& scene = stage.scene;
  Settings settings = settings_for();
  settings.aovs = {"light_groups", "object"};
  Checked checked(settings);
  checked.expect(scene, "everything", "the first image");
  scene.set(stage.bulb, PointLight{{9, 1, 1}, {1, 2, 2}});
  checked.expect(scene, "lights", "a value");
  scene.set_transform(stage.instances[1], Transform::translate({0, 0.5, 0.5}));
  checked.expect(scene, "transforms", "an instance");
  scene.add(Light(PointLight{1, {0, 2, 2}}, "another"));
  checked.expect(scene, "everything", "another group");
}

/// The lamp that a new scene without lights has comes and goes.
TEST(RendererChangesOf, TheNeutralLight) {
  Scene scene;
  scene.add(Shape{Sphere{}});
  scene.set_film({.width = 12, .height = 8});
  Checked checked(settings_for());
  checked.expect(scene, "everything", "the first image");
  const LightId lamp = scene.add(PointLight{10, {0, 3, 3}});
  checked.expect(scene, "lights", "a light of its own");
  scene.remove(lamp);
  checked.expect(scene, "lights", "none again");
  scene.set_environment(Colour(0));
  checked.expect(scene, "lights", "darkness");
}

/// What is said of lost light is of the scene as it is.
TEST(RendererChangesOf, WarningsOfLostLight) {
  Stage stage;
  Scene& scene = stage.scene;
  scene.set(stage.bulb, PointLight{40, {-1, 3, 0}});
  Checked checked(settings_for());
  checked.expect(scene, "everything", "with glass");
  const auto warns = [&] {
    const std::vector<Warning> warnings = checked.renderer.warnings();
    return std::any_of(warnings.begin(), warnings.end(),
                       [](const Warning& warning) { return warning.message.find("is lost at") != std::string::npos; });
  };
  EXPECT_TRUE(warns());
  const MaterialId glass = scene.shape(stage.ball).material;
  scene.set(glass, Diffuse{});
  checked.expect(scene, "materials", "without glass");
  EXPECT_FALSE(warns());
  scene.set(glass, Dielectric{});
  checked.expect(scene, "materials", "with glass again");
  EXPECT_TRUE(warns());
  scene.set(stage.bulb, PointLight{0, {-1, 3, 0}});
  scene.set(stage.sun, DistantLight{0, {0, -1, 0}});
  checked.expect(scene, "lights", "in the dark");
  EXPECT_FALSE(warns());
}

}  // namespace

}  // namespace alhazen

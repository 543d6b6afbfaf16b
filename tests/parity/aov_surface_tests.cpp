// Albedo, normal and depth of what is seen through glass and in mirrors.

#include <algorithm>
#include <array>
#include <cmath>

#include "parity/engines.h"
#include "parity/scenes.h"

namespace alhazen::impl::test {

namespace {

/// The mean of a layer of three channels, of which `first` is the number.
std::array<double, 3> mean_of_layer(const Outcome& outcome, size_t first) {
  const size_t channels = outcome.channels.size(), width = static_cast<size_t>(outcome.width),
               height = static_cast<size_t>(outcome.height);
  std::array<double, 3> sums{};
  for (size_t y = 0; y < height; ++y)
    for (size_t c = 0; c < 3; ++c)
      for (size_t x = 0; x < width; ++x)
        sums[c] += static_cast<double>(outcome.rows[(y * channels + first + c) * width + x]);
  for (double& sum : sums) sum /= static_cast<double>(width * height);
  return sums;
}

/// A wall at y = 4 of albedo (0.8, 0.4, 0.2), whose normal is -y, seen from the origin through `between` only.
Scene wall_behind(const std::string& between) {
  return scene_of(R"(LookAt 0 0 0  0 1 0  0 0 1
Camera "perspective" "float fov" 4
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
AttributeBegin Material "diffuse" "rgb reflectance" [ 0.8 0.4 0.2 ]
Shape "trianglemesh" "point3 P" [ -9 4 -9  9 4 -9  9 4 9  -9 4 9 ] "integer indices" [ 0 1 2 0 2 3 ] AttributeEnd
)" + between);
}

Settings layer_settings(const char* surface) {
  Settings settings;
  settings.backend = "serial";
  settings.samples_per_pixel = 64;
  settings.aovs = {"albedo", "normal", "distance"};
  settings.aov_surface = surface;
  return settings;
}

constexpr const char* pane = R"(Material "thindielectric"
Shape "trianglemesh" "point3 P" [ -1 1 -1  1 1 -1  1 1 1  -1 1 1 ] "integer indices" [ 0 1 2 0 2 3 ])";

TEST(AovSurface, IsTheFirstUnlessAskedFor) {
  for (const char* surface : {"", "first"}) {
    const Outcome outcome = render_bits(wall_behind(pane), layer_settings(surface));
    const auto albedo = mean_of_layer(outcome, 3), last = mean_of_layer(outcome, 7);
    for (const double value : albedo) EXPECT_NEAR(value, 1, 1e-6);
    EXPECT_NEAR(last[2], 1, 0.01);
  }
}

TEST(AovSurface, IsSeenThroughGlass) {
  const Outcome outcome = render_bits(wall_behind(pane), layer_settings("diffuse"));
  // A pane of index 1.5 transmits 12 of 13 parts; what it reflects meets nothing, and counts as white.
  const auto albedo = mean_of_layer(outcome, 3), normal = mean_of_layer(outcome, 6);
  EXPECT_NEAR(albedo[0], (0.8 * 12 + 1) / 13, 0.02);
  EXPECT_NEAR(albedo[1], (0.4 * 12 + 1) / 13, 0.02);
  EXPECT_NEAR(albedo[2], (0.2 * 12 + 1) / 13, 0.02);
  EXPECT_NEAR(normal[1], -12.0 / 13 + 1.0 / 13, 0.03);  // the ray that is reflected faces the other way
}

/// Light is refracted into a ball, which does not change the albedo of what is in it.
TEST(AovSurface, IsSeenInsideGlass) {
  const Scene scene = wall_behind(R"(Material "dielectric" "float eta" 1.5
AttributeBegin Translate 0 2 0 Shape "sphere" "float radius" 1 AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.2 0.6 0.4 ]
AttributeBegin Translate 0 2 0 Shape "sphere" "float radius" 0.5 AttributeEnd)");
  const Outcome outcome = render_bits(scene, layer_settings("diffuse"));
  // A part of 0.04 is reflected, and meets nothing; that counts as white.
  const auto albedo = mean_of_layer(outcome, 3);
  EXPECT_NEAR(albedo[0], 0.2 * 0.96 + 0.04, 0.02);
  EXPECT_NEAR(albedo[1], 0.6 * 0.96 + 0.04, 0.02);
  EXPECT_NEAR(albedo[2], 0.4 * 0.96 + 0.04, 0.02);
}

/// What meets nothing but a mirror counts as white, and tells the mirror from the background.
TEST(AovSurface, ReachesTheSkyInAMirror) {
  const Scene scene = scene_of(R"(LookAt 0 0 0  0 1 0  0 0 1
Camera "perspective" "float fov" 90
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
Material "conductor" "rgb reflectance" [ 0.9 0.9 0.9 ] "float roughness" 0
AttributeBegin Translate 0 3 0 Shape "sphere" "float radius" 1 AttributeEnd)");
  const Outcome outcome = render_bits(scene, layer_settings("diffuse"));
  const auto at = [&](size_t x, size_t y, size_t channel) { return outcome.rows[(y * 10 + channel) * 16 + x]; };
  ASSERT_EQ(outcome.channels.size(), 10u);
  EXPECT_NEAR(at(8, 8, 3), 0.9, 0.02);    // albedo
  EXPECT_GT(std::abs(at(8, 8, 7)), 0.8);  // normal
  for (size_t channel = 3; channel < 10; ++channel) EXPECT_EQ(at(0, 0, channel), 0);
}

TEST(AovSurface, IsSeenInMirrors) {
  // Of 45 degrees, towards x, where a wall of albedo (0.2, 0.6, 0.4) is.
  const Scene scene = wall_behind(R"(Material "conductor" "rgb reflectance" [ 0.5 0.7 0.9 ] "float roughness" 0
Shape "trianglemesh" "point3 P" [ -1 0 -1  1 2 -1  1 2 1  -1 0 1 ] "integer indices" [ 0 1 2 0 2 3 ]
Material "diffuse" "rgb reflectance" [ 0.2 0.6 0.4 ]
Shape "trianglemesh" "point3 P" [ 5 -9 -9  5 9 -9  5 9 9  5 -9 9 ] "integer indices" [ 0 1 2 0 2 3 ])");
  const Outcome outcome = render_bits(scene, layer_settings("diffuse"));
  const auto albedo = mean_of_layer(outcome, 3), normal = mean_of_layer(outcome, 6);
  // At 45 degrees a metal reflects a little more than at 0.
  EXPECT_NEAR(albedo[0], 0.2 * 0.5, 0.01);
  EXPECT_NEAR(albedo[1], 0.6 * 0.7, 0.02);
  EXPECT_NEAR(albedo[2], 0.4 * 0.9, 0.02);
  EXPECT_NEAR(normal[0], 1, 1e-5);  // by the order of its vertices
}

TEST(AovSurface, HasTheSameBitsByAllEngines) {
  for (const char* name : {"spheres", "environments", "materials"}) {
    SCOPED_TRACE(name);
    Settings settings = layer_settings("diffuse");
    settings.samples_per_pixel = 19;
    const Outcome expected = render_bits(parity_scene(name), settings);
    visit_engines(settings, [&](const Settings& other) {
      SCOPED_TRACE(other.backend + " " + other.strategy + " " + other.schedule);
      EXPECT_TRUE(same_bits(expected, render_bits(parity_scene(name), other)));
    });
    // Radiance does not depend on it.
    Settings first = settings;
    first.aov_surface = "first";
    const Outcome other = render_bits(parity_scene(name), first);
    const size_t channels = expected.channels.size(), width = static_cast<size_t>(expected.width);
    for (size_t y = 0; y < static_cast<size_t>(expected.height); ++y) {
      const auto row = static_cast<std::ptrdiff_t>(y * channels * width);
      EXPECT_TRUE(std::equal(expected.rows.begin() + row,
                             expected.rows.begin() + row + static_cast<std::ptrdiff_t>(3 * width),
                             other.rows.begin() + row));
    }
    EXPECT_NE(mean_of_layer(other, 3), mean_of_layer(expected, 3));
  }
}

TEST(AovSurface, OfDenoisingIsDiffuseUnlessItsLayersAreWritten) {
  Settings settings;
  settings.denoiser = "builtin";
  const Scene scene = wall_behind(pane);
  EXPECT_TRUE(resolve_settings(settings, scene).records_through_specular);
  settings.aov_surface = "first";
  EXPECT_FALSE(resolve_settings(settings, scene).records_through_specular);
  settings.aov_surface = "";
  settings.aovs = {"distance"};
  EXPECT_FALSE(resolve_settings(settings, scene).records_through_specular);
  settings.aov_surface = "diffuse";
  EXPECT_TRUE(resolve_settings(settings, scene).records_through_specular);
  settings.integrator = "iterative";
  EXPECT_THROW(resolve_settings(settings, scene), InputError);
  settings.aov_surface = "second";
  EXPECT_THROW(resolve_settings(settings, scene), InputError);
}

}  // namespace

}  // namespace alhazen::impl::test

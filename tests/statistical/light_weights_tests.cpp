// The density of a light is that of its sampler, so that the MIS weights of both techniques sum to 1: measured in
// furnaces, where every surface of albedo a emits (1 - a) L under a sky of radiance L, so that everything has the
// radiance L. Tested for scenes at any position and of any size, seen from inside, outside and on the lights.

#include <gtest/gtest.h>

#include <cmath>

#include "support/compiled_scenes.h"
#include "support/effort.h"
#include "support/random.h"
#include "support/reals.h"
#include "support/render_pixels.h"

namespace alhazen::impl::test {
namespace {

constexpr uint32_t side = 12;
constexpr double level = 2;

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof(text), "%.9g ", x);
  return text;
}
std::string numbers(const Vec3d& v) { return number(v.x) + number(v.y) + number(v.z); }

std::string camera_at(const Vec3d& eye, const Vec3d& target) {
  return film_of(side, side) + "LookAt " + numbers(eye) + numbers(target) +
         "0 1 0 Camera \"perspective\" \"float fov\" 90\n";
}

/// Emission and reflectance that add up to the level of the furnace.
std::string surface(double albedo, const std::string& emission = "\"bool twosided\" true") {
  return "AreaLightSource \"diffuse\" \"rgb L\" [ " + numbers(splat((1 - albedo) * level)) + "] " + emission +
         " Material \"diffuse\" \"rgb reflectance\" [ " + numbers(splat(albedo)) + "] ";
}

/// `tolerance`: of the position's rounding in float.
template <class Real>
void expect_level(const CompiledScene<Real>& scene, double tolerance, uint32_t samples = 64) {
  const Take take{IntegratorKind::path, SamplerType::independent, 40, static_cast<uint32_t>(effort(samples)), 3};
  const Moments pixels = render_pixels(scene.view, take, side, side);
  EXPECT_GT(mean_p_value(pixels, level, level * tolerance), 1e-4)
      << pixels.mean() << " +- " << pixels.standard_error() << " instead of " << level;
  EXPECT_LT(pixels.standard_error(), widened(0.02) * level) << "the test is blunt";
}

/// Positions: distances in radii.
const Vec3d places[] = {{0, 0, 0}, {30, -50, 40}, {300, -250, 340}, {1000, 900, -1000}, {9000, -5000, 7000}};
constexpr double scales[] = {1e-6, 1, 1e5};

template <class Real>
class LightWeights : public ::testing::Test {};
TYPED_TEST_SUITE(LightWeights, Reals);

/// Inside a sphere that emits inwards: points on it see only the light itself.
TYPED_TEST(LightWeights, InsideAnEmissiveSphere) {
  using Real = TypeParam;
  const std::string moving = "ActiveTransform EndTime Translate ";
  for (const Vec3d& place : places)
    for (const double scale : scales)
      for (const bool moves : {false, true}) {
        SCOPED_TRACE(numbers(place) + " times " + number(scale) + (moves ? "moving" : ""));
        const Vec3d centre = place * scale;
        const std::string text = camera_at(centre, centre + Vec3d{scale, scale / 2, 0}) +
                                 "WorldBegin ReverseOrientation " + surface(0.5, "") +
                                 (moves ? moving + numbers(Vec3d{0.3, 0, 0} * scale) + "ActiveTransform All " : "") +
                                 "Translate " + numbers(centre) + "Shape \"sphere\" \"float radius\" " + number(scale);
        expect_level(compiled_scene_of<Real>(text), 3e-3, 16);
      }
}

/// The same for a sphere with an emission texture.
TYPED_TEST(LightWeights, InsideASphereWithAnEmissionTexture) {
  using Real = TypeParam;
  for (const Vec3d& place : places) {
    SCOPED_TRACE(numbers(place));
    Scene scene = described_scene(camera_at(place, place + Vec3d{1, 0.5, 0}) + "WorldBegin ReverseOrientation " +
                                  surface(0.5, "") + "Translate " + numbers(place) + "Shape \"sphere\"");
    Texture half;
    half.kind = TextureKind::constant;
    half.value = splat(0.5);
    scene.textures.push_back(half);
    Emission& emission = *scene.groups[0].shapes[0].emission;
    emission.texture = static_cast<uint32_t>(scene.textures.size() - 1);
    emission.radiance = emission.radiance * 2;
    expect_level(compiled_scene<Real>(std::move(scene)), 3e-3, 16);
  }
}

/// Spheres that touch, intersect and contain each other, triangles inside and across them, all of them lights; seen
/// from outside and from inside.
std::string crowd(const Vec3d& place, double scale) {
  std::string text;
  Random random(4);
  for (int i = 0; i < 24; ++i) {
    const Vec3d p = (place + random.in_box(-2, 2)) * scale;
    text += "AttributeBegin " + surface(random.between(0.3, 0.8));
    if (i % 3 == 0)
      text += "Shape \"trianglemesh\" \"point3 P\" [ " + numbers(p) + numbers(p + random.in_box(-1, 1) * scale) +
              numbers(p + random.in_box(-1, 1) * scale) + "]";
    else if (i % 3 == 1)
      text +=
          "Translate " + numbers(p) + "Shape \"sphere\" \"float radius\" " + number(random.between(0.2, 0.8) * scale);
    else
      text += "ActiveTransform EndTime Translate " + numbers(random.in_box(-0.5, 0.5) * scale) +
              "ActiveTransform All Translate " + numbers(p) + "Shape \"sphere\" \"float radius\" " +
              number(random.between(0.2, 0.8) * scale);
    text += " AttributeEnd\n";
  }
  // One that contains most of the others and has the same centre as the tree.
  return text + "AttributeBegin " + surface(0.6) + "Translate " + numbers(place * scale) +
         "Shape \"sphere\" \"float radius\" " + number(2 * scale) + " AttributeEnd\n";
}

TYPED_TEST(LightWeights, AmongManyLights) {
  using Real = TypeParam;
  for (const char* sampler : {"bvh", "power"})
    for (const Vec3d& place : places)
      for (const double scale : scales)
        for (const bool inside : {false, true}) {
          SCOPED_TRACE(std::string(sampler) + ", " + numbers(place) + " times " + number(scale) +
                       (inside ? "inside" : "outside"));
          const Vec3d eye = (place + (inside ? Vec3d{0.1, 0.3, -0.2} : Vec3d{0, 0.5, -4})) * scale;
          const std::string text = "Integrator \"path\" \"string lightsampler\" \"" + std::string(sampler) + "\"\n" +
                                   camera_at(eye, (place + Vec3d{0.5, 0.1, 0.3}) * scale) + "WorldBegin " +
                                   "LightSource \"infinite\" \"rgb L\" [ " + numbers(splat(level)) + "]\n" +
                                   crowd(place, scale);
          expect_level(compiled_scene_of<Real>(text), by_precision<Real>(4e-3, 1e-3), 32);
        }
}

/// A plane below a sphere, so close that it nearly touches, and far away: E = pi L (r / d)^2 below its centre.
TYPED_TEST(LightWeights, SphereAboveAPlane) {
  using Real = TypeParam;
  for (const Vec3d& place : places)
    for (const double gap : {0.01, 0.1, 1.0, 30.0}) {
      // The smallest gaps that float resolves.
      if (sizeof(Real) == sizeof(float) && gap < length(place) * 2e-5) continue;
      SCOPED_TRACE(numbers(place) + " gap " + number(gap));
      const std::string text =
          film_of(side, side) + "LookAt " + numbers(place + Vec3d{0, gap / 3, gap}) + numbers(place) +
          "0 1 0 Camera \"perspective\" \"float fov\" 0.05 WorldBegin Translate " + numbers(place) +
          "Material \"diffuse\" \"rgb reflectance\" [1 1 1] Shape \"trianglemesh\" \"point3 P\" [-90 0 -90  90 0 -90  "
          "90 0 90  -90 0 90] \"integer indices\" [0 2 1 0 3 2] Translate 0 " +
          number(1 + gap) + " 0 AreaLightSource \"diffuse\" \"rgb L\" [ " + numbers(splat(level * sqr(1 + gap))) +
          "] Shape \"sphere\"";
      const CompiledScene<Real> scene = compiled_scene_of<Real>(text);
      const Take take{IntegratorKind::path, SamplerType::independent, 2, static_cast<uint32_t>(effort(64)), 3};
      const Moments pixels = render_pixels(scene.view, take, side, side);
      EXPECT_GT(mean_p_value(pixels, level, level * by_precision<Real>(5e-3, 1e-3)), 1e-4)
          << pixels.mean() << " +- " << pixels.standard_error();
    }
}

/// A sun that fills the upper hemisphere, over a floor and boxes that emit: the choice between both, at every point.
TYPED_TEST(LightWeights, BoxesUnderASun) {
  using Real = TypeParam;
  const std::string box =
      "Shape \"trianglemesh\" \"point3 P\" [0 0 0  1 0 0  1 1 0  0 1 0  0 0 1  1 0 1  1 1 1  0 1 1] \"integer "
      "indices\" "
      "[0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 2 3 7 2 7 6 0 4 7 0 7 3 1 2 6 1 6 5]\n";
  for (const double albedo : {0.3, 0.8}) {
    SCOPED_TRACE(albedo);
    const CompiledScene<Real> scene = compiled_scene_of<Real>(
        film_of(side, side) + "LookAt 3 -4 3  0.5 0.5 0  0 0 1 Camera \"perspective\" \"float fov\" 50 WorldBegin " +
        "LightSource \"distant\" \"point3 from\" [0 0 1] \"point3 to\" [0 0 0] \"float angle\" 180 \"float scale\" " +
        number(pi<double> * level) + surface(albedo) +
        "Shape \"trianglemesh\" \"point3 P\" [-1e4 -1e4 0  1e4 -1e4 0  1e4 1e4 0  -1e4 1e4 0] \"integer indices\" [0 1 "
        "2 0 2 "
        "3] AttributeBegin Translate 0 0 0.5 " +
        box + "AttributeEnd AttributeBegin Translate -1.5 0.2 0.1 Rotate 30 1 1 1 " + box + "AttributeEnd");
    ASSERT_GT(scene.view.light_tree_count, 0u);
    ASSERT_GT(scene.view.infinite_irradiance, Real(0));
    expect_level(scene, 1e-3);
  }
}

}  // namespace
}  // namespace alhazen::impl::test

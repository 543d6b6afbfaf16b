// sample_light against pdf_light: for every kind of light with a density, from several points, the sampled directions
// against the density of rays along them; and the radiance of samples against that of rays.

#include <gtest/gtest.h>

#include "core/bvh/brute_force/intersector.h"
#include "core/integrators/stages.h"
#include "support/direction_histogram.h"
#include "support/effort.h"
#include "support/primitive_scenes.h"
#include "support/random.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

struct LightCase {
  std::string name, text;
  Vec3d reference;
  double time;
  Vec3d axis;        ///< of the cap that contains the light
  double theta_max;  ///< half angle of the cap
  Vec3d normal{};    ///< of the side from which light must arrive
};

const std::string triangle = R"(WorldBegin AreaLightSource "diffuse" "rgb L" [1 1 1] "bool twosided" true
    Shape "trianglemesh" "point3 P" [-1 -1 3  2 -1 4  0 1 3] "integer indices" [0 1 2])";
const std::string sphere = R"(WorldBegin Translate 0 0 3 AreaLightSource "diffuse" "rgb L" [1 1 1] "bool twosided" true
    Shape "sphere" "float radius" 1)";
const std::string moving_sphere = R"(WorldBegin ActiveTransform EndTime Translate 2 0 0 ActiveTransform All
    Translate 0 0 3 AreaLightSource "diffuse" "rgb L" [1 1 1] "bool twosided" true Shape "sphere" "float radius" 1)";
/// Their radiance is 1.
const std::string sun = R"(WorldBegin LightSource "distant" "point3 from" [1 2 3] "point3 to" [0 0 0] "float angle" 20
    "float scale" 0.09473060974812199)";
const std::string wide_sun =
    R"(WorldBegin LightSource "distant" "point3 from" [0 0 -1] "point3 to" [0 0 0] "float angle" 120
    "float scale" 2.35619449019234)";
/// No light occludes another as seen from the origin. The edge of the sun is one of the bins of the histogram.
const std::string several = R"(WorldBegin LightSource "distant" "float angle" 118.125 "float scale" 0.3
    AreaLightSource "diffuse" "rgb L" [2 1 1] "bool twosided" true
    Shape "trianglemesh" "point3 P" [-1 -1 3  2 -1 4  0 1 3] "integer indices" [0 1 2]
    Translate -4 0 0 AreaLightSource "diffuse" "rgb L" [3 4 5] "bool twosided" true
    Shape "sphere" "float radius" 1)";

/// Enough lights for a light tree; none occludes another.
const std::string many = R"(WorldBegin LightSource "distant" "float angle" 118.125 "float scale" 0.3
    AreaLightSource "diffuse" "rgb L" [2 1 1] "bool twosided" true
    Shape "trianglemesh" "point3 P" [-1 -1 3  2 -1 4  0 1 3] "integer indices" [0 1 2]
    Shape "trianglemesh" "point3 P" [-1 -1 -3  2 -1 -4  0 1 -3] "integer indices" [0 1 2]
    Shape "trianglemesh" "point3 P" [3 -1 -1  4 -1 2  3 1 0] "integer indices" [0 1 2]
    AttributeBegin Translate -4 0 0 AreaLightSource "diffuse" "rgb L" [3 4 5] Shape "sphere" AttributeEnd
    AttributeBegin Translate 0 5 0 AreaLightSource "diffuse" "rgb L" [1 2 3] Shape "sphere" AttributeEnd
    AttributeBegin Translate 0 -9 0 AreaLightSource "diffuse" "rgb L" [1 1 1] Shape "sphere" AttributeEnd)";

const LightCase light_cases[] = {
    {"triangle", triangle, {}, 0, {0.3, -0.3, 3.3}, 0.9},
    {"triangle from the side", triangle, {3, -0.5, 1}, 0, {-2.7, 0.2, 2.3}, 0.9},
    {"triangle from close by", triangle, {0.3, -0.5, 3}, 0, {0, 0, 1}, pi<double>},
    {"triangle from close by and askew", triangle, {0.3, -0.5, 3}, 0, {0, 0, 1}, pi<double>, {0.6, 0, 0.8}},
    {"triangle across the horizon", triangle, {0.5, 0, 2.5}, 0, {0, 0, 1}, pi<double>, {-0.8, 0.6, 0}},
    {"sphere", sphere, {}, 0, {0, 0, 1}, std::asin(1 / 3.0) * (1 + 1e-5)},
    {"sphere from close by", sphere, {0.1, 0, 1.9}, 0, {0, 0, 1}, pi<double>},
    {"sphere from far away", sphere, {300, 200, 100}, 0, {-300, -200, -97}, 0.003},
    {"sphere from inside", sphere, {0.2, -0.5, 3.3}, 0, {0, 0, 1}, pi<double>},
    {"moving sphere", moving_sphere, {}, 0.75, {1.5, 0, 3}, 0.35},
    {"moving sphere from inside", moving_sphere, {0.8, 0, 3}, 0.25, {0, 0, 1}, pi<double>},
    {"sun", sun, {}, 0, {1, 2, 3}, 10.001 * pi<double> / 180},
    {"wide sun", wide_sun, {1, 2, 3}, 0, {0, 0, -1}, 60.001 * pi<double> / 180},
    {"several", several, {}, 0, {0, 0, 1}, pi<double>},
    {"many", many, {}, 0, {0, 0, 1}, pi<double>},
};
constexpr size_t cases = 2 * std::size(light_cases);

/// The density with which any of the lights gives this direction: that of the surface that the ray hits, and that of
/// the lights at infinity behind all surfaces.
template <class Real>
Real pdf_of_direction(const SceneView<Real>& scene, const Ray<Real>& ray, const Vec3<Real>& normal = {}) {
  Hit<Real> hit;
  Real pdf = 0;
  const Real by_tree = light_tree_probability(scene, ray.origin, normal);
  for (uint32_t i = 0; i < scene.far_lights_count; ++i) {
    const LightRecord<Real>& light = scene.lights[scene.far_lights[i]];
    pdf += light.pmf * (1 - by_tree) * escaped_light(scene, light, normal, ray.direction, true).pdf;
  }
  if (BruteForceIntersector<Real>(scene).closest_hit(ray, infinity<Real>, hit)) {
    const SurfaceInteraction<Real> si = surface_interaction(scene, ray, hit);
    pdf += pdf_light(scene, scene.lights[scene.surfaces[si.surface].light], ray, hit, si, normal);
  }
  return pdf;
}

template <class Real>
class LightSampling : public ::testing::Test {};
TYPED_TEST_SUITE(LightSampling, Reals);

TYPED_TEST(LightSampling, DirectionsFollowTheDensity) {
  using Real = TypeParam;
  for (const LightCase& c : light_cases) {
    const CompiledScene<Real> scene = compiled_scene_of<Real>(c.text);
    const Vec3<Real> reference = convert<Real>(c.reference), normal = convert<Real>(c.normal);
    const Real time = static_cast<Real>(c.time);
    DirectionHistogram histogram(frame_about(normalize(c.axis)), c.theta_max);
    Random random(1);
    for (size_t i = 0; i < effort(1'000'000); ++i) {
      const LightSample<Real> s = sample_light(scene.view, reference, normal, time, random.uniform_2d<Real>());
      if (s.pdf > 0)
        histogram.add(convert<double>(s.direction));
      else
        histogram.add_nothing();
    }
    double integral = 0;
    const ChiSquared test = histogram.test(
        [&](const Vec3d& w) {
          return pdf_of_direction(scene.view, Ray<Real>{reference, convert<Real>(w), time}, normal);
        },
        integral);
    EXPECT_NEAR(integral, 1, 1e-3) << c.name;
    EXPECT_GT(test.p_value, sidak(0.01, cases)) << c.name << ": " << test.statistic << " for "
                                                << test.degrees_of_freedom << " degrees of freedom, " << integral;
  }
}

TYPED_TEST(LightSampling, RayFindsWhatWasSampled) {
  using Real = TypeParam;
  for (const LightCase& c : light_cases) {
    if (&c >= &light_cases[std::size(light_cases) - 2]) continue;  // there the sun adds to the density
    const CompiledScene<Real> scene = compiled_scene_of<Real>(c.text);
    Random random(2);
    for (int i = 0; i < 2000; ++i) {
      const Vec3<Real> reference = convert<Real>(c.reference), normal = convert<Real>(c.normal);
      const Real time = static_cast<Real>(c.time);
      const LightSample<Real> s = sample_light(scene.view, reference, normal, time, random.uniform_2d<Real>());
      EXPECT_FALSE(s.is_delta);
      EXPECT_NEAR(static_cast<double>(s.radiance.y), 1, 1e-6);
      // If the light is seen edge-on, rounding decides whether and where it is hit.
      if (s.is_finite && abs_dot(s.normal, s.direction) < Real(0.2)) continue;
      const Real pdf = pdf_of_direction(scene.view, Ray<Real>{reference, s.direction, time}, normal);
      ASSERT_NEAR(static_cast<double>(pdf / s.pdf), 1, by_precision<Real>(5e-3, 1e-9)) << c.name;
    }
  }
}

/// Rounding puts a point of a lamp before or behind it. Its light must not seem to come from the whole hemisphere.
TYPED_TEST(LightSampling, ALampDoesNotLightItself) {
  using Real = TypeParam;
  const CompiledScene<Real> scene = compiled_scene_of<Real>(triangle);
  const TriangleEmitter<Real>& t = scene.view.triangle_emitters[0];
  const Vec3<Real> front = normalize(cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]));
  Random random(3);
  for (int i = 0; i < 10'000; ++i) {
    const Vec2<Real> b = sample_triangle(random.uniform_2d<Real>());
    const Vec3<Real> reference = t.corner[0] * b.x + t.corner[1] * b.y + t.corner[2] * (1 - b.x - b.y);
    const LightSample<Real> s = sample_light(scene.view, reference, front, Real(0), random.uniform_2d<Real>());
    if (!(s.pdf > 0)) continue;
    ASSERT_LT(static_cast<double>(abs_dot(s.direction, front) / s.pdf), by_precision<Real>(1e-3, 1e-9));
  }
}

/// A lamp much larger than its distance is seen by shadow rays, however uncertain it is where they meet it.
TYPED_TEST(LightSampling, LampsAreSeenWhateverTheirSize) {
  using Real = TypeParam;
  for (const double size : {1.0, 1e2, 1e3, 1e4, 1e6}) {
    const std::string side = std::to_string(size);
    const CompiledScene<Real> scene = compiled_scene_of<Real>(
        "WorldBegin AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] Shape \"trianglemesh\" \"point3 P\" [-" + side +
        " -" + side + " 10 " + side + " -" + side + " 10 " + side + " " + side + " 10 -" + side + " " + side +
        " 10] \"integer indices\" [0 2 1 0 3 2]");
    const BruteForceIntersector<Real> intersector(scene.view);
    SurfaceInteraction<Real> si{};
    si.position = {Real(0.3), Real(-0.2), 0};
    si.position_error = splat(Real(0));
    si.normal = si.shading_normal = {0, 0, 1};
    Random random(5);
    int hidden = 0;
    Moments irradiance;
    for (int i = 0; i < 20'000; ++i) {
      const LightSample<Real> s = sample_light(scene.view, si.position, si.normal, Real(0), random.uniform_2d<Real>());
      ASSERT_GT(s.pdf, Real(0)) << size;
      if (!is_unoccluded(intersector, shadow_ray(si, s))) ++hidden;
      irradiance.add(static_cast<double>(s.direction.z / s.pdf) / pi<double>);
    }
    EXPECT_EQ(hidden, 0) << size;
    // By area, most samples of a huge lamp are far away: then BSDF sampling finds it.
    if (size == 1e2 || size == 1e3) {
      EXPECT_NEAR(irradiance.mean(), size == 1e2 ? 0.99 : 1, 0.03) << size;
    }
  }
}

/// Radiance times cosine over all directions is the irradiance that the file gives, also for a disk as small as the
/// sun; and so is the weight by which the light is chosen.
TYPED_TEST(LightSampling, SunHasTheIrradianceOfADistantLight) {
  using Real = TypeParam;
  for (const double angle : {0.01, 0.533, 20.0, 120.0, 180.0}) {
    const CompiledScene<Real> scene = compiled_scene_of<Real>(
        "WorldBegin LightSource \"distant\" \"rgb L\" [3 3 3] \"point3 from\" [1 2 3] \"point3 to\" [0 0 0] \"float "
        "angle\" " +
        std::to_string(angle) + " LightSource \"distant\" \"rgb L\" [2 2 2]");
    const Frame<double> axes = frame_about(normalize(Vec3d{1, 2, 3}));
    const LightRecord<Real>& light = scene.view.lights[scene.view.far_lights[0]];
    ASSERT_EQ(light.kind, LightKind::sun);
    // Rings of equal width, to a little beyond the edge, and twelve directions in each.
    constexpr int rings = 20000, sectors = 12;
    const double end = std::min(angle * 0.55, 90.0) * pi<double> / 180, width = end / rings;
    double irradiance = 0, probability = 0;
    for (int ring = 0; ring < rings; ++ring)
      for (int sector = 0; sector < sectors; ++sector) {
        const double theta = (ring + 0.5) * width, phi = 2 * pi<double> * (sector + 0.3) / sectors;
        const Vec3d local{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
        const double solid_angle = 2 * pi<double> / sectors * std::sin(theta) * width;
        const EscapedLight<Real> found =
            escaped_light(scene.view, light, Vec3<Real>{}, convert<Real>(axes.to_world(local)), true);
        irradiance += static_cast<double>(found.radiance.y) * std::cos(theta) * solid_angle;
        probability += static_cast<double>(found.pdf) * solid_angle;
      }
    // In float, directions are rounded by 1e-3 of the smallest disk.
    const double tolerance = by_precision<Real>(angle < 0.1 ? 5e-3 : 5e-4, 2e-4);
    EXPECT_NEAR(irradiance, 3, 3 * tolerance) << angle;
    EXPECT_NEAR(probability, 1, tolerance) << angle;
    EXPECT_NEAR(static_cast<double>(light.pmf), 3.0 / 5, 1e-6) << angle;
  }
}

TYPED_TEST(LightSampling, LightsWithoutSizeAreSampledSurely) {
  using Real = TypeParam;
  for (const std::string light : {"LightSource \"point\" \"point3 from\" [0 5 0]",
                                  "LightSource \"spot\" \"point3 from\" [0 5 0] \"point3 to\" [0 0 0]",
                                  "LightSource \"distant\" \"point3 from\" [0 5 0] \"point3 to\" [0 0 0]"}) {
    const CompiledScene<Real> scene = compiled_scene_of<Real>("WorldBegin " + light);
    const LightSample<Real> s = sample_light(scene.view, Vec3<Real>{}, Vec3<Real>{}, Real(0), Vec2<Real>{Real(0.3), 0});
    EXPECT_TRUE(s.is_delta);
    EXPECT_EQ(s.pdf, Real(1));
    EXPECT_NEAR(static_cast<double>(s.direction.y), 1, 1e-6);
  }
}

/// Probabilities sum to 1, the cumulative ones agree with them, and lights are chosen as often as they say.
TYPED_TEST(LightSampling, Probabilities) {
  using Real = TypeParam;
  const CompiledScene<Real> scene =
      compiled_scene_of<Real>("Integrator \"path\" \"string lightsampler\" \"power\" " + several + R"(
      LightSource "point" "rgb I" [1 2 3]
      LightSource "spot" "rgb I" [3 2 1]
      LightSource "distant" "rgb L" [1 1 1]
      AreaLightSource "diffuse" "rgb L" [0 0 0]
      Shape "sphere"
  )");
  const SceneView<Real>& view = scene.view;
  ASSERT_EQ(view.lights_count, 6u);
  double sum = 0;
  std::vector<double> expected, observed(view.lights_count);
  constexpr int samples = 100'000;
  for (uint32_t i = 0; i < view.lights_count; ++i) {
    EXPECT_GT(view.lights[i].pmf, Real(0));
    EXPECT_NEAR(static_cast<double>(view.light_cdf[i]), sum, 1e-6);
    sum += static_cast<double>(view.lights[i].pmf);
    expected.push_back(static_cast<double>(view.lights[i].pmf) * samples);
  }
  EXPECT_NEAR(sum, 1, by_precision<Real>(1e-6, 1e-14));
  EXPECT_EQ(view.light_cdf[view.lights_count], Real(1));
  Random random(3);
  for (int i = 0; i < samples; ++i) ++observed[sample_cdf(view.light_cdf, view.lights_count, random.uniform<Real>())];
  EXPECT_GT(chi_squared_test(observed, expected).p_value, 0.001);
}

}  // namespace
}  // namespace alhazen::impl::test

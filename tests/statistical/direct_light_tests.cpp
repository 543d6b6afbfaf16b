// Direct light on a point of a plane, against irradiance in closed form. The plane is y = 0, seen from close by with so
// narrow a field of view that it is one point; its albedo is 1, so that radiance is irradiance / pi.

#include <gtest/gtest.h>

#include <vector>

#include "support/compiled_scenes.h"
#include "support/effort.h"
#include "support/reals.h"
#include "support/render_pixels.h"

namespace alhazen::impl::test {
namespace {

constexpr uint32_t side = 16;
constexpr size_t cases = 2 * 2 * (6 + 3 + 5 + 4);  // precisions, samplers, lights of each test

const std::string head = film_of(side, side) + R"(
    LookAt 0.3 0.4 -0.5  0 0 0  0 1 0
    Camera "perspective" "float fov" 0.001
    WorldBegin
    Material "diffuse" "rgb reflectance" [1 1 1]
    Shape "trianglemesh" "point3 P" [-1 0 -1  1 0 -1  1 0 1  -1 0 1] "integer indices" [0 2 1 0 3 2]
)";

template <class Real>
void expect_irradiance(const CompiledScene<Real>& scene, IntegratorKind integrator, double expected,
                       double relative_rounding) {
  for (const SamplerType sampler : all_samplers) {
    const Take take{integrator, sampler, 2, static_cast<uint32_t>(effort(256)), 17};
    const Moments pixels = render_pixels(scene.view, take, side, side);
    const double radiance = expected / pi<double>;
    EXPECT_GT(mean_p_value(pixels, radiance, radiance * relative_rounding), sidak(0.01, cases))
        << take.name() << ": " << pixels.mean() << " +- " << pixels.standard_error() << " instead of " << radiance;
    // A sixteenth of the samples has four times the error.
    EXPECT_LT(pixels.standard_error(), (is_sanitized ? 0.08 : 0.02) * radiance) << take.name() << ": the test is blunt";
  }
}

/// The width of the view moves the point by about 1e-5; in float rounding adds to that.
template <class Real>
constexpr double tolerance = by_precision<Real>(1e-4, 2e-5);

template <class Real>
class DirectLight : public ::testing::Test {};
TYPED_TEST_SUITE(DirectLight, Reals);

TYPED_TEST(DirectLight, PointSpotDistant) {
  using Real = TypeParam;
  const auto expect = [](const std::string& light, double irradiance) {
    SCOPED_TRACE(light);
    expect_irradiance(compiled_scene_of<Real>(head + light), IntegratorKind::path, irradiance, tolerance<Real>);
  };
  // I cos / d^2 with d^2 = 14 and cos = 3 / sqrt(14).
  const double at_point = 3 / std::pow(14, 1.5);
  expect("LightSource \"point\" \"rgb I\" [20 20 20] \"point3 from\" [1 3 -2]", 20 * at_point);
  // Inside the cone of full intensity, and outside of the cone.
  const std::string spot = "LightSource \"spot\" \"rgb I\" [20 20 20] \"point3 from\" [1 3 -2] ";
  expect(spot + "\"point3 to\" [0.1 0 0] \"float coneangle\" 20 \"float conedeltaangle\" 5", 20 * at_point);
  // 45 degrees off the axis, halfway in cosine between falloff and edge, where the smooth step is 1/2:
  // cos 45 = (cos inner + cos outer) / 2.
  const double inner = std::acos(std::sqrt(0.5) + 0.1) * 180 / pi<double>;
  const double outer = std::acos(std::sqrt(0.5) - 0.1) * 180 / pi<double>;
  expect("LightSource \"spot\" \"rgb I\" [8 8 8] \"point3 from\" [0 2 0] \"point3 to\" [2 0 0] \"float coneangle\" " +
             std::to_string(outer) + " \"float conedeltaangle\" " + std::to_string(outer - inner),
         0.5 * 8 / 4);
  expect("LightSource \"distant\" \"rgb L\" [2 2 2] \"point3 from\" [0 1 1] \"point3 to\" [0 0 0]", 2 * std::sqrt(0.5));
  expect("LightSource \"infinite\" \"rgb L\" [0.5 0.5 0.5]", 0.5 * pi<double>);
  // The light of all lights arrives, whichever is chosen.
  expect(
      "LightSource \"point\" \"rgb I\" [20 20 20] \"point3 from\" [1 3 -2]\n"
      "LightSource \"distant\" \"rgb L\" [2 2 2] \"point3 from\" [0 1 1] \"point3 to\" [0 0 0]\n"
      "LightSource \"infinite\" \"rgb L\" [0.5 0.5 0.5]",
      20 * at_point + 2 * std::sqrt(0.5) + 0.5 * pi<double>);
}

/// A disk above the horizon has the irradiance of its middle, E cos, whatever its size: by light sampling with BSDF
/// sampling, and by BSDF sampling alone.
TYPED_TEST(DirectLight, Sun) {
  using Real = TypeParam;
  for (const double angle : {0.533, 60.0}) {
    SCOPED_TRACE(angle);
    const std::string sun =
        "LightSource \"distant\" \"rgb L\" [2 2 2] \"point3 from\" [0 1 1] \"point3 to\" [0 0 0] \"float angle\" ";
    const CompiledScene<Real> scene = compiled_scene_of<Real>(head + sun + std::to_string(angle));
    expect_irradiance(scene, IntegratorKind::path, 2 * std::sqrt(0.5), tolerance<Real>);
    if (angle > 1) expect_irradiance(scene, IntegratorKind::iterative, 2 * std::sqrt(0.5), tolerance<Real>);
  }
  // With a sky and a point light, whichever is chosen.
  expect_irradiance(compiled_scene_of<Real>(head + R"(
      LightSource "distant" "rgb L" [2 2 2] "point3 from" [0 1 1] "point3 to" [0 0 0] "float angle" 60
      LightSource "point" "rgb I" [20 20 20] "point3 from" [1 3 -2]
      LightSource "infinite" "rgb L" [0.5 0.5 0.5])"),
                    IntegratorKind::path, 2 * std::sqrt(0.5) + 20 * 3 / std::pow(14, 1.5) + 0.5 * pi<double>,
                    tolerance<Real>);
}

/// A whole sphere above the horizon: E = pi L (r / d)^2 cos.
template <class Real>
void check_sphere(const Vec3d& centre, double radius, IntegratorKind integrator) {
  const double d = length(centre), radiance = sqr(d / radius);
  const auto number = [](double x) { return std::to_string(x) + " "; };
  const std::string light = "Translate " + number(centre.x) + number(centre.y) + number(centre.z) +
                            "AreaLightSource \"diffuse\" \"rgb L\" [" + number(radiance) + number(radiance) +
                            number(radiance) + "] Shape \"sphere\" \"float radius\" " + number(radius);
  SCOPED_TRACE(light);
  expect_irradiance(compiled_scene_of<Real>(head + light), integrator, pi<double> * centre.y / d, tolerance<Real>);
}

TYPED_TEST(DirectLight, Sphere) {
  check_sphere<TypeParam>({1, 3, -2}, 0.5, IntegratorKind::path);
  check_sphere<TypeParam>({0.5, 2, 0.5}, 1.5, IntegratorKind::path);
  check_sphere<TypeParam>({0.5, 2, 0.5}, 1.5, IntegratorKind::iterative);
}

/// A sphere so small and far away that float cannot tell its centre from its surface.
TYPED_TEST(DirectLight, TinyFarSphere) { check_sphere<TypeParam>({1000, 3000, -2000}, 0.0001, IntegratorKind::path); }

/// Irradiance at the origin on a plane with normal +y from a polygon above it (Lambert 1760): the sum over its edges of
/// the angle that the edge subtends times the cosine of the plane that it spans.
double polygon_irradiance(const std::vector<Vec3d>& corners, double radiance) {
  double sum = 0;
  for (size_t i = 0; i < corners.size(); ++i) {
    const Vec3d a = normalize(corners[i]), b = normalize(corners[(i + 1) % corners.size()]);
    sum += std::acos(dot(a, b)) * normalize(cross(a, b)).y;
  }
  return 0.5 * radiance * std::abs(sum);
}

std::string mesh_light(const std::vector<Vec3d>& corners, const std::string& radiance) {
  std::string points, indices;
  for (const Vec3d& p : corners)
    points += std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "  ";
  for (size_t i = 1; i + 1 < corners.size(); ++i)
    indices += "0 " + std::to_string(i) + " " + std::to_string(i + 1) + "  ";
  return "AreaLightSource \"diffuse\" \"rgb L\" [" + radiance + "] \"bool twosided\" true\n" +
         "Shape \"trianglemesh\" \"point3 P\" [" + points + "] \"integer indices\" [" + indices + "]";
}

TYPED_TEST(DirectLight, Polygons) {
  using Real = TypeParam;
  const std::vector<Vec3d> triangle{{-1, 2, 1}, {1.5, 3, 0.5}, {0.5, 1, 2}};
  const std::vector<Vec3d> quad{{-1, 1, -1}, {1.5, 1, -1}, {1.5, 2, 1}, {-1, 2, 1}};
  for (const IntegratorKind integrator : {IntegratorKind::path, IntegratorKind::iterative})
    for (const std::vector<Vec3d>& corners : {triangle, quad}) {
      SCOPED_TRACE(corners.size());
      expect_irradiance(compiled_scene_of<Real>(head + mesh_light(corners, "3 3 3")), integrator,
                        polygon_irradiance(corners, 3), tolerance<Real>);
    }
}

TYPED_TEST(DirectLight, Disk) {
  using Real = TypeParam;
  const CompiledScene<Real> scene = compiled_scene_of<Real>(head + R"(
      Translate 0 2 0
      Rotate 90 1 0 0
      AreaLightSource "diffuse" "rgb L" [3 3 3]
      Shape "disk" "float radius" 1.2
  )");
  // The disk is a polygon of 128 corners with the same area here; L pi r^2 / (r^2 + h^2) is the value for a disk.
  const double r = 1.2 * std::sqrt(2 * pi<double> / 128 / std::sin(2 * pi<double> / 128));
  std::vector<Vec3d> corners;
  for (int i = 0; i < 128; ++i) {
    const double phi = 2 * pi<double> * i / 128;
    corners.push_back({r * std::cos(phi), 2, r * std::sin(phi)});
  }
  const double expected = polygon_irradiance(corners, 3);
  EXPECT_NEAR(expected, 3 * pi<double> * 1.44 / (1.44 + 4), 2e-4 * expected);
  expect_irradiance(scene, IntegratorKind::path, expected, tolerance<Real>);
}

}  // namespace
}  // namespace alhazen::impl::test

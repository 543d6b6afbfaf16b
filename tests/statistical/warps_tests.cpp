// The mappings from the unit square against their densities: disks, triangles, spheres of directions, visible normals,
// pixel filters.

#include <gtest/gtest.h>

#include "compile/camera.h"
#include "core/cameras/filter.h"
#include "core/materials/lobes/microfacet.h"
#include "core/shapes/sphere.h"
#include "core/shapes/triangle.h"
#include "support/chi_squared_grid.h"
#include "support/compiled_scenes.h"
#include "support/direction_histogram.h"
#include "support/effort.h"
#include "support/random.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

constexpr double alphas[] = {0.05, 0.3, 0.8};
constexpr double normal_cosines[] = {1, 0.8, 0.5, 0.1, 0.01};
constexpr FilterType filters[] = {FilterType::box, FilterType::triangle, FilterType::gaussian, FilterType::mitchell,
                                  FilterType::sinc};
/// Precisions; two disks, triangle, three of directions, five of spheres, visible normals, filters.
constexpr size_t cases = 2 * (2 + 1 + 3 + 5 + std::size(alphas) * std::size(normal_cosines) + 2 * std::size(filters));

void expect_fits(const ChiSquared& test, const std::string& what) {
  EXPECT_GT(test.p_value, sidak(0.01, cases))
      << what << ": " << test.statistic << " for " << test.degrees_of_freedom << " degrees of freedom";
}

template <class Real>
class WarpOf : public ::testing::Test {};
TYPED_TEST_SUITE(WarpOf, Reals);

/// Uniform over a disk: radius squared and angle are uniform over a rectangle.
template <class Real, class Sample>
void check_disk(const Sample& sample, const std::string& what) {
  UniformGrid grid(64, 32);
  Random random(1);
  for (size_t i = 0; i < effort(1'000'000); ++i) {
    const Vec2<Real> q = sample(random);
    const double x = static_cast<double>(q.x), y = static_cast<double>(q.y);
    ASSERT_LE(x * x + y * y, 1 + 1e-6);
    grid.add(std::min(x * x + y * y, one_minus_epsilon<double>),
             std::min(std::atan2(y, x) / (2 * pi<double>)+0.5, one_minus_epsilon<double>));
  }
  expect_fits(grid.test(), what);
}

TYPED_TEST(WarpOf, Disks) {
  using Real = TypeParam;
  check_disk<Real>([](Random& r) { return sample_disk(r.uniform_2d<Real>()); }, "concentric disk");
  check_disk<Real>([](Random& r) { return sample_disk_polar(r.uniform_2d<Real>()); }, "polar disk");
}

/// Uniform over a triangle: 1 - sqrt(1 - b0) is the position along, b1 / (1 - b0) the position across, both uniform.
TYPED_TEST(WarpOf, Triangle) {
  using Real = TypeParam;
  UniformGrid grid(64, 64);
  Random random(2);
  for (size_t i = 0; i < effort(1'000'000); ++i) {
    const Vec2<Real> b = sample_triangle(random.uniform_2d<Real>());
    ASSERT_TRUE(b.x >= 0 && b.y >= 0 && b.x + b.y <= 1);
    const double b0 = static_cast<double>(b.x), b1 = static_cast<double>(b.y);
    grid.add(std::min(1 - sqr(1 - b0), one_minus_epsilon<double>), std::min(b1 / (1 - b0), one_minus_epsilon<double>));
  }
  expect_fits(grid.test(), "triangle");
}

template <class Real, class Sample, class Pdf>
void check_directions(const Vec3d& axis, double theta_max, const Sample& sample, const Pdf& pdf,
                      const std::string& what) {
  DirectionHistogram histogram(frame_about(normalize(axis)), theta_max);
  Random random(3);
  for (size_t i = 0; i < effort(1'000'000); ++i) histogram.add(convert<double>(sample(random.uniform_2d<Real>())));
  double integral = 0;
  expect_fits(histogram.test([&](const Vec3d& w) { return pdf(convert<Real>(w)); }, integral), what);
  EXPECT_NEAR(integral, 1, 1e-3) << what;
}

TYPED_TEST(WarpOf, Directions) {
  using Real = TypeParam;
  check_directions<Real>(
      {0, 0, 1}, pi<double> / 2, [](const Vec2<Real>& u) { return sample_cosine_hemisphere(u); },
      [](const Vec3<Real>& w) { return pdf_cosine_hemisphere(w.z); }, "cosine hemisphere");
  check_directions<Real>(
      {0, 0, 1}, pi<double>, [](const Vec2<Real>& u) { return sample_uniform_sphere(u); },
      [](const Vec3<Real>&) { return pdf_uniform_sphere<Real>; }, "sphere of directions");
  check_directions<Real>(
      {1, 2, -2}, pi<double>, [](const Vec2<Real>& u) { return sample_cosine_hemisphere(u); },
      [](const Vec3<Real>& w) { return pdf_cosine_hemisphere(w.z); }, "cosine hemisphere, from askew");
}

/// pdf_sphere along a direction, at the point where the direction hits the sphere.
template <class Real>
Real pdf_towards(const Vec3<Real>& centre, Real radius, const Vec3<Real>& point, const Vec3<Real>& w) {
  Real t;
  if (!intersect_sphere(Ray<Real>{point, w}, centre, radius, infinity<Real>, t)) return 0;
  return pdf_sphere(centre, radius, point, w, t, normalize(point + w * t - centre));
}

TYPED_TEST(WarpOf, Spheres) {
  using Real = TypeParam;
  const Vec3d point{1, -2, 0.5};
  struct Case {
    Vec3d centre;
    double radius;
  };
  // Far, near, just outside the surface, inside off the centre, inside near the surface.
  for (const Case& c : {Case{{5, 1, 9}, 0.1}, Case{{2, -1, 2}, 1}, Case{{1, -1, 0.5}, 0.999}, Case{{1.5, -2, 1}, 2},
                        Case{{1, -2, 1.4}, 1}}) {
    const double distance = length(c.centre - point);
    const bool outside = distance > c.radius;
    const double theta_max = outside ? std::asin(c.radius / distance) : pi<double>;
    const Vec3<Real> centre = convert<Real>(c.centre), from = convert<Real>(point);
    const Real radius = static_cast<Real>(c.radius);
    check_directions<Real>(
        c.centre - point, theta_max * (1 + 1e-6),
        [&](const Vec2<Real>& u) {
          Vec3<Real> normal;
          Real pdf;
          const Vec3<Real> w = sample_sphere(centre, radius, from, false, u, normal, pdf);
          EXPECT_GT(pdf, Real(0));
          return w;
        },
        [&](const Vec3<Real>& w) {
          // The last ring of the cone may be outside it by rounding.
          return outside ? pdf_sphere(centre, radius, from, w, Real(1), -w) : pdf_towards(centre, radius, from, w);
        },
        "sphere at distance " + std::to_string(distance) + ", radius " + std::to_string(c.radius));
  }
}

/// The sample of sample_sphere agrees with the hit of the ray along its direction.
TYPED_TEST(WarpOf, SampledSphereNormalIsThatOfTheHit) {
  using Real = TypeParam;
  Random random(4);
  for (int i = 0; i < 20'000; ++i) {
    const Vec3<Real> point = convert<Real>(random.in_box(-1, 1)), centre = convert<Real>(random.in_box(-3, 3));
    const Real radius = static_cast<Real>(random.between(0.1, 2));
    Vec3<Real> normal;
    Real pdf, t;
    const Vec3<Real> w = sample_sphere(centre, radius, point, false, random.uniform_2d<Real>(), normal, pdf);
    // At the silhouette and at the surface rounding decides.
    if (abs_dot(w, normal) < Real(0.05) || std::abs(length(centre - point) - radius) < Real(0.05)) continue;
    ASSERT_TRUE(intersect_sphere(Ray<Real>{point, w}, centre, radius, infinity<Real>, t));
    const Vec3<Real> hit_normal = normalize(point + w * t - centre);
    ASSERT_NEAR(static_cast<double>(length(hit_normal - normal)), 0, by_precision<Real>(2e-4, 1e-12));
    ASSERT_NEAR(static_cast<double>(pdf_sphere(centre, radius, point, w, t, hit_normal) / pdf), 1,
                by_precision<Real>(1e-2, 1e-10));
  }
}

TYPED_TEST(WarpOf, VisibleNormals) {
  using Real = TypeParam;
  for (const double alpha : alphas)
    for (const double cosine : normal_cosines) {
      const Vec3<Real> w = normalize(
          convert<Real>(Vec3d{safe_sqrt(1 - cosine * cosine) * 0.6, safe_sqrt(1 - cosine * cosine) * 0.8, cosine}));
      const Real a = static_cast<Real>(alpha);
      check_directions<Real>(
          {0, 0, 1}, pi<double> / 2, [&](const Vec2<Real>& u) { return sample_visible_normal(w, a, u); },
          [&](const Vec3<Real>& m) { return pdf_visible_normal(w, m, a); },
          "visible normals, alpha " + std::to_string(alpha) + ", cosine " + std::to_string(cosine));
    }
}

/// The integral of |f| over each of `bins` equal parts of [-radius, radius].
std::vector<double> filter_fractions(const Filter& filter, double radius, size_t bins) {
  std::vector<double> fractions(bins);
  double total = 0;
  constexpr int points = 256;
  for (size_t i = 0; i < bins; ++i)
    for (int k = 0; k < points; ++k) {
      const double x = radius * (2 * (static_cast<double>(i) + (k + 0.5) / points) / static_cast<double>(bins) - 1);
      fractions[i] += std::abs(filter_value(filter, x, radius));
      total += std::abs(filter_value(filter, x, radius));
    }
  for (double& fraction : fractions) fraction /= total;
  return fractions;
}

TYPED_TEST(WarpOf, Filters) {
  using Real = TypeParam;
  for (const FilterType type : filters) {
    Scene scene;
    scene.filter = {type, 2, 1.5};
    const Filter filter = scene.filter;
    const CompiledScene<Real> flat = compiled_scene<Real>(std::move(scene));
    // Bins are cells of the table, within which the filter is constant.
    constexpr size_t bins = 128;
    std::vector<double> x_counts(bins), y_counts(bins);
    Random random(5);
    const size_t samples = effort(1'000'000);
    const auto bin_of = [](double x, double radius) {
      return std::min(static_cast<size_t>((x / radius + 1) / 2 * bins), bins - 1);
    };
    for (size_t i = 0; i < samples; ++i) {
      const FilterSample<Real> s = sample_filter(flat.view.filter, flat.view.filter_cdf, random.uniform_2d<Real>());
      const double x = static_cast<double>(s.offset.x), y = static_cast<double>(s.offset.y);
      ASSERT_TRUE(std::abs(x) <= 2 && std::abs(y) <= 1.5);
      ++x_counts[bin_of(x, 2)];
      ++y_counts[bin_of(y, 1.5)];
      const double value = filter_value(filter, x, 2) * filter_value(filter, y, 1.5);
      if (std::abs(value) > 0.01) {
        ASSERT_EQ(static_cast<double>(s.weight), value < 0 ? -1 : 1) << x << ", " << y;
      }
    }
    std::vector<double> x_expected = filter_fractions(filter, 2, bins),
                        y_expected = filter_fractions(filter, 1.5, bins);
    for (double& e : x_expected) e *= static_cast<double>(samples);
    for (double& e : y_expected) e *= static_cast<double>(samples);
    expect_fits(chi_squared_test(x_counts, x_expected), "filter along x, " + std::to_string(static_cast<int>(type)));
    expect_fits(chi_squared_test(y_counts, y_expected), "filter along y, " + std::to_string(static_cast<int>(type)));
  }
}

}  // namespace
}  // namespace alhazen::impl::test

// Environment maps: sampled directions against the density, for surfaces of any normal and of some, the density against
// 1 and against the radiance above the mean, radiance over density against the integral of the map, and images with and
// without light sampling.

#include <gtest/gtest.h>

#include <set>

#include "core/lights/light.h"
#include "support/direction_histogram.h"
#include "support/effort.h"
#include "support/environments.h"
#include "support/reals.h"
#include "support/render_pixels.h"

namespace alhazen::impl::test {
namespace {

struct MapCase {
  std::string name;
  ImageTexels map;
  Frame<double> axes;
};

std::vector<MapCase> map_cases() {
  return {{"equirectangular sun", sun_map(32, 16, 1000), map_as_world},
          {"equirectangular sun, askew", sun_map(32, 16, 1000), map_askew()},
          {"equirectangular lamps", lamps_map(16, 8), map_askew()},
          {"octahedral sun", sun_map(16, 16, 1000), map_as_world},
          {"octahedral sun, askew", sun_map(16, 16, 1000), map_askew()},
          {"octahedral lamps", lamps_map(16, 16), map_askew()},
          {"equirectangular with uneven cells", sun_map(100, 50, 20), map_askew()},
          {"octahedral with uneven cells", sun_map(37, 37, 20), map_as_world}};
}

template <class Real>
class EnvironmentSampling : public ::testing::Test {};
TYPED_TEST_SUITE(EnvironmentSampling, Reals);

/// The first means that light may arrive from anywhere.
const Vec3d normals[] = {{0, 0, 0}, {0, 0, 1}, {0.6, -0.64, -0.48}};

TYPED_TEST(EnvironmentSampling, DirectionsFollowTheDensity) {
  using Real = TypeParam;
  const std::vector<MapCase> cases = map_cases();
  for (const MapCase& c : cases) {
    const CompiledScene<Real> scene = compiled_scene<Real>(map_alone(c.map, c.axes));
    const EnvironmentRecord<Real>& map = scene.view.environments[0];
    // There are lamps at the poles, where the density is too steep for bins other than the map's.
    const bool has_lamps = c.name.find("lamps") != std::string::npos;
    for (const Vec3d& normal : normals) {
      const Vec3<Real> n = convert<Real>(normal);
      DirectionHistogram histogram(has_lamps ? c.axes : map_as_world, pi<double>);
      Random random(1);
      for (size_t i = 0; i < effort(1'000'000); ++i) {
        const LightSample<Real> s = sample_light(scene.view, Vec3<Real>{}, n, Real(0), random.uniform_2d<Real>());
        if (s.pdf > 0)
          histogram.add(convert<double>(s.direction));
        else
          histogram.add_nothing();
      }
      double integral = 0;
      const ChiSquared test = histogram.test(
          [&](const Vec3d& w) { return pdf_environment(scene.view, map, n, convert<Real>(w)); }, integral);
      EXPECT_NEAR(integral, 1, 1e-3) << c.name;
      EXPECT_GT(test.p_value, sidak(0.01, 2 * cases.size() * std::size(normals)))
          << c.name << ": " << test.statistic << " for " << test.degrees_of_freedom << " degrees of freedom";
    }
  }
}

TEST(EnvironmentSampling, GroupsAreOfSimilarNormals) {
  Random random(6);
  std::set<uint32_t> groups;
  for (int i = 0; i < 200'000; ++i) {
    const Vec3d n = sample_uniform_sphere(random.uniform_2d<double>());
    const uint32_t group = normal_group(n);
    ASSERT_LT(group, any_normal_group);
    groups.insert(group);
    ASSERT_GT(dot(n, normal_of_group<double>(group)), 0) << group;
    ASSERT_LE(length(cross(n, normal_of_group<double>(group))), normal_group_radius) << group;
  }
  EXPECT_EQ(groups.size(), any_normal_group);
  for (uint32_t group = 0; group < any_normal_group; ++group) {
    EXPECT_EQ(normal_group(normal_of_group<double>(group)), group);
    EXPECT_EQ(normal_group(normal_of_group<float>(group)), group);
  }
  EXPECT_EQ(normal_group(Vec3d{}), any_normal_group);
  EXPECT_EQ(normal_group(Vec3d{std::nan(""), 0, 1}), any_normal_group);
}

/// Cells cover the map, and the places of their distributions follow one another.
TEST(EnvironmentSampling, CellsCoverTheMap) {
  for (const auto& [width, height] : {std::pair{1u, 1u}, {2u, 1u}, {3u, 3u}, {34u, 17u}, {37u, 37u}, {100u, 50u}}) {
    EnvironmentRecord<double> map{};
    map.width = width, map.height = height;
    map.cell_columns = std::min(width, 16u), map.cell_rows = std::min(height, 16u);
    uint64_t next = uint64_t{normal_groups} * cell_distribution_size(map);
    uint32_t texels = 0;
    for (uint32_t row = 0; row < map.cell_rows; ++row)
      for (uint32_t column = 0; column < map.cell_columns; ++column) {
        const EnvironmentCell cell = environment_cell(map, column, row);
        EXPECT_EQ(cell.first, next) << width << " " << column << " " << row;
        next += cell.height + 1 + cell.height * (cell.width + 1);
        texels += cell.width * cell.height;
        for (uint32_t i = 0; i < cell.width; ++i) EXPECT_EQ(cell_of_texel(cell.x + i, width, map.cell_columns), column);
        for (uint32_t i = 0; i < cell.height; ++i) EXPECT_EQ(cell_of_texel(cell.y + i, height, map.cell_rows), row);
      }
    EXPECT_EQ(texels, width * height);
  }
}

/// Fewer samples arrive below the surface than of those for any normal, though some suns are just below; and what is
/// above is sampled.
TYPED_TEST(EnvironmentSampling, SamplesArriveAboveTheSurface) {
  using Real = TypeParam;
  for (const MapCase& c : map_cases()) {
    const CompiledScene<Real> scene = compiled_scene<Real>(map_alone(c.map, c.axes));
    const EnvironmentRecord<Real>& map = scene.view.environments[0];
    Random random(4);
    int below = 0, below_of_any = 0;
    for (int k = 0; k < 20; ++k) {
      const Vec3<Real> normal = sample_uniform_sphere(random.uniform_2d<Real>());
      for (int i = 0; i < 2000; ++i) {
        const Vec2<Real> u = random.uniform_2d<Real>();
        const EnvironmentSample<Real> s = sample_environment(scene.view, map, normal, u);
        below += s.pdf > 0 && dot(s.direction, normal) < 0 ? 1 : 0;
        const EnvironmentSample<Real> other = sample_environment(scene.view, map, Vec3<Real>{}, u);
        below_of_any += dot(other.direction, normal) < 0 ? 1 : 0;
        if (dot(other.direction, normal) > Real(0.05)) {
          ASSERT_GT(pdf_environment(scene.view, map, normal, other.direction), Real(0)) << c.name;
        }
      }
    }
    EXPECT_LT(below, 0.6 * below_of_any) << c.name;
  }
}

TYPED_TEST(EnvironmentSampling, WhatIsSampledIsWhatARayFinds) {
  using Real = TypeParam;
  for (const MapCase& c : map_cases()) {
    const CompiledScene<Real> scene = compiled_scene<Real>(map_alone(c.map, c.axes, 3));
    const EnvironmentRecord<Real>& map = scene.view.environments[0];
    Random random(2);
    size_t differing = 0;
    for (int i = 0; i < 100'000; ++i) {
      const EnvironmentSample<Real> s = sample_environment(scene.view, map, Vec3<Real>{}, random.uniform_2d<Real>());
      ASSERT_GT(s.pdf, Real(0)) << c.name;
      ASSERT_NEAR(static_cast<double>(length(s.direction)), 1, 1e-6) << c.name;
      // Near the poles of one mapping rounding changes directions a lot.
      if (map.mapping == SphereMapping::equirectangular && abs_dot(map.axes.normal, s.direction) > Real(0.9999))
        continue;
      const Vec3<Real> found = evaluate_environment(scene.view, map, s.direction);
      const double scale = static_cast<double>(max_component(found)) + 1;
      ASSERT_LT(static_cast<double>(length(found - s.radiance)), by_precision<Real>(0.01, 1e-9) * scale) << c.name;
      const double ratio = static_cast<double>(pdf_environment(scene.view, map, Vec3<Real>{}, s.direction) / s.pdf);
      if (std::abs(ratio - 1) > by_precision<Real>(1e-3, 1e-9)) ++differing;  // rounded into the next texel
    }
    EXPECT_LT(differing, by_precision<Real>(100, 1)) << c.name;
  }
}

TYPED_TEST(EnvironmentSampling, RadianceOverDensityIsTheIntegral) {
  using Real = TypeParam;
  const std::vector<MapCase> cases = map_cases();
  for (const MapCase& c : cases) {
    const CompiledScene<Real> scene = compiled_scene<Real>(map_alone(c.map, c.axes));
    const EnvironmentRecord<Real>& map = scene.view.environments[0];
    const double expected = integral_over_sphere(1024, [&](const Vec3d& d) {
      const EnvironmentSample<Real> found =
          evaluate_environment_and_pdf(scene.view, map, Vec3<Real>{}, convert<Real>(d), true);
      return found.pdf > 0 ? static_cast<double>(found.radiance.y) : 0;
    });
    Moments moments;
    Random random(3);
    for (size_t i = 0; i < effort(1'000'000); ++i) {
      const EnvironmentSample<Real> s = sample_environment(scene.view, map, Vec3<Real>{}, random.uniform_2d<Real>());
      moments.add(s.pdf > 0 ? static_cast<double>(s.radiance.y / s.pdf) : 0);
    }
    EXPECT_GT(mean_p_value(moments, expected, 2e-4 * expected), sidak(0.01, 2 * cases.size()))
        << c.name << ": " << moments.mean() << " +- " << moments.standard_error() << " instead of " << expected;
    // A density constant over texels cannot follow the slopes between them, but other noise is negligible.
    const bool is_mostly_noise = c.name.find("uneven") != std::string::npos;  // with a sun that is not much brighter
    EXPECT_LT(moments.variance(), (is_mostly_noise ? 3 : 1.5) * expected * expected)
        << c.name << ": the sampler does not follow the map";
  }
}

/// A texel has a density if it is brighter than the mean of the map, however bright the brightest is; else not.
TYPED_TEST(EnvironmentSampling, WhatIsAboveTheMeanIsSampled) {
  using Real = TypeParam;
  for (MapCase& c : map_cases()) {
    if (c.name.find("sun") != std::string::npos) {  // two suns; in float the sky is lost beside one of them
      for (size_t k = 0; k < 3; ++k) channel_of(c.map, c.map.width * 5 / 8, c.map.height * 3 / 8, k) = 1e12f;
      for (size_t k = 0; k < 3; ++k) channel_of(c.map, c.map.width * 2 / 8, c.map.height * 4 / 8, k) = 2e10f;
    }
    const CompiledScene<Real> scene = compiled_scene<Real>(map_alone(c.map, c.axes));
    const EnvironmentRecord<Real>& map = scene.view.environments[0];
    const auto brightness = [&](const Vec3<Real>& radiance) { return luminance(convert<double>(radiance)); };
    const double mean =
        integral_over_sphere(
            1024, [&](const Vec3d& d) { return brightness(evaluate_environment(scene.view, map, convert<Real>(d))); }) /
        (4 * pi<double>);
    size_t brighter = 0, darker = 0;
    for (uint32_t row = 0; row < map.height; ++row)
      for (uint32_t column = 0; column < map.width; ++column) {
        double least = infinity<double>, most = 0;
        for (int i = 0; i < 16; ++i) {
          const Vec2<Real> uv{
              (static_cast<Real>(column) + (Real(i % 4) + Real(0.5)) / 4) / static_cast<Real>(map.width),
              (static_cast<Real>(row) + (Real(i / 4) + Real(0.5)) / 4) / static_cast<Real>(map.height)};
          const double value = brightness(lookup_environment(scene.view, map, uv));
          least = std::min(least, value);
          most = std::max(most, value);
        }
        const Real density = environment_square_pdf(scene.view, map, any_normal_group, row, column);
        if (least > 1.01 * mean) {
          EXPECT_GT(density, Real(0)) << c.name << " " << column << " " << row;
          ++brighter;
        } else if (most < 0.99 * mean) {
          EXPECT_EQ(density, Real(0)) << c.name << " " << column << " " << row;
          ++darker;
        }
      }
    EXPECT_GT(darker, 10u) << c.name;
    EXPECT_GT(brighter, 0u) << c.name;
  }
}

/// Maps and skies without contrast are found by BSDF sampling alone.
TYPED_TEST(EnvironmentSampling, ConstantRadianceIsNotSampled) {
  using Real = TypeParam;
  for (const auto& [width, height] : {std::pair{1, 1}, {8, 8}, {16, 8}}) {
    const CompiledScene<Real> scene = compiled_scene<Real>(map_alone(even_map(width, height, 0.3f), map_askew()));
    Random random(4);
    for (int i = 0; i < 1000; ++i)
      EXPECT_EQ(sample_light(scene.view, Vec3<Real>{}, Vec3<Real>{}, Real(0), random.uniform_2d<Real>()).pdf, Real(0));
    EXPECT_NEAR(static_cast<double>(background_radiance(scene.view, Vec3<Real>{0, 0, 1}).x), 0.3, 1e-6);
  }
  const CompiledScene<Real> scene = compiled_scene_of<Real>("WorldBegin LightSource \"infinite\"");
  EXPECT_EQ(scene.view.lights_count, 0u);
  EXPECT_EQ(scene.statistics.lights, 1u);
}

TYPED_TEST(EnvironmentSampling, ChosenByWhatIsAboveTheMean) {
  using Real = TypeParam;
  // Maps whose light is half above the mean, of mean 1 and 3 in double, and a constant light.
  ImageTexels halves = even_map(8, 4, 0);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 8; ++x)
      for (size_t k = 0; k < 3; ++k) channel_of(halves, x, y, k) = 2;
  Scene scene = described_scene("WorldBegin LightSource \"infinite\" \"rgb L\" [2 2 2]");
  scene = lit_by(lit_by(lit_by(std::move(scene), halves), halves, map_askew(), 3), even_map(4, 4, 1));
  const CompiledScene<Real> flat = compiled_scene<Real>(std::move(scene));
  ASSERT_EQ(flat.view.lights_count, 3u);
  ASSERT_EQ(flat.view.environments_count, 3u);
  const auto pmf = [&](uint32_t map) {
    return static_cast<double>(flat.view.lights[flat.view.environments[map].light].pmf);
  };
  EXPECT_NEAR(pmf(0), 1.0 / 4, 1e-6);
  EXPECT_NEAR(pmf(1), 3.0 / 4, 1e-6);
  EXPECT_EQ(pmf(2), 0);
  // All of them contribute when a ray escapes.
  const Vec3<Real> radiance = background_radiance(flat.view, Vec3<Real>{0, 0, 1});
  EXPECT_GT(static_cast<double>(radiance.x), 3 - 1e-5);
}

constexpr uint32_t side = 16;

/// Objects on and above a plane see the map in all directions.
const std::string objects = film_of(side, side) + R"(
    LookAt 0 -5 2.5  0 0 0.4  0 0 1
    Camera "perspective" "float fov" 40
    WorldBegin
    Material "diffuse" "rgb reflectance" [0.6 0.6 0.6]
    Shape "trianglemesh" "point3 P" [-9 -9 0  9 -9 0  9 9 0  -9 9 0] "integer indices" [0 1 2 0 2 3]
    AttributeBegin Translate -1.1 0 0.6 Shape "sphere" "float radius" 0.6 AttributeEnd
    Material "conductor" "rgb reflectance" [0.9 0.9 0.9] "float roughness" 0.2
    AttributeBegin Translate 0.2 0.5 0.6 Shape "sphere" "float radius" 0.6 AttributeEnd
    Material "dielectric" "float eta" 1.5
    AttributeBegin Translate 1.3 -0.3 0.6 Shape "sphere" "float radius" 0.6 AttributeEnd
)";

TYPED_TEST(EnvironmentSampling, IntegratorsAgree) {
  using Real = TypeParam;
  // A second map and a constant light in addition to the one with a sun, so that weights are those of each light.
  for (const int width : {32, 16}) {
    Scene described = described_scene(objects + "LightSource \"infinite\" \"rgb L\" [0.2 0.2 0.2]");
    described = lit_by(lit_by(std::move(described), sun_map(width, 16, 60)), lamps_map(8, 8), map_askew());
    const CompiledScene<Real> scene = compiled_scene<Real>(std::move(described));
    std::array<Moments, std::size(all_integrators)> moments;
    for (size_t i = 0; i < moments.size(); ++i)
      for (uint32_t run = 0; run < effort(32); ++run) {
        const Take take{all_integrators[i], SamplerType::sobol, 5, 16, static_cast<uint32_t>(1000 * i) + run};
        moments[i].add(render_pixels(scene.view, take, side, side).mean());
      }
    for (size_t i = 0; i < moments.size(); ++i)
      for (size_t j = i + 1; j < moments.size(); ++j)
        EXPECT_GT(welch_p_value(moments[i], moments[j], 1e-6), sidak(0.01, 2 * 2 * 6))
            << to_string(all_integrators[i]) << " " << moments[i].mean() << " +- " << moments[i].standard_error()
            << ", " << to_string(all_integrators[j]) << " " << moments[j].mean() << " +- "
            << moments[j].standard_error();
    // Only next-event estimation finds a sun.
    EXPECT_LT(moments[3].standard_error(), 0.7 * moments[2].standard_error());
    EXPECT_LT(moments[2].standard_error(), (is_sanitized ? 0.06 : 0.01) * moments[2].mean()) << "the test is blunt";
  }
}

/// The irradiance of a plane, by light sampling and by BSDF sampling, against the integral over the map.
TYPED_TEST(EnvironmentSampling, IrradianceOfAPlane) {
  using Real = TypeParam;
  const std::string plane = film_of(side, side) + R"(
      LookAt 0 0 1  0 0.1 0  0 0 1
      Camera "perspective" "float fov" 0.001
      WorldBegin
      Material "diffuse" "rgb reflectance" [1 1 1]
      Shape "trianglemesh" "point3 P" [-9 -9 0  9 -9 0  9 9 0  -9 9 0] "integer indices" [0 1 2 0 2 3]
      LightSource "infinite" "rgb L" [0 0 0]
  )";
  for (const MapCase& c : map_cases()) {
    const CompiledScene<Real> scene = compiled_scene<Real>(lit_by(described_scene(plane), c.map, c.axes));
    const EnvironmentRecord<Real>& map = scene.view.environments[0];
    const double irradiance = integral_over_sphere(1024, [&](const Vec3d& d) {
      const Vec3d radiance = convert<double>(evaluate_environment(scene.view, map, convert<Real>(d)));
      return luminance(radiance) * std::max(d.z, 0.0);
    });
    for (const IntegratorKind integrator : {IntegratorKind::path, IntegratorKind::iterative}) {
      const Take take{integrator, SamplerType::independent, 2, static_cast<uint32_t>(effort(256)), 5};
      const Moments pixels = render_pixels(scene.view, take, side, side);
      EXPECT_GT(mean_p_value(pixels, irradiance / pi<double>, 5e-4 * irradiance), sidak(0.01, 2 * 2 * 6))
          << c.name << ", " << take.name() << ": " << pixels.mean() << " +- " << pixels.standard_error()
          << " instead of " << irradiance / pi<double>;
      if (integrator == IntegratorKind::path) {
        EXPECT_LT(pixels.standard_error(), (is_sanitized ? 0.08 : 0.02) * irradiance / pi<double>) << c.name;
      }
    }
  }
}

}  // namespace
}  // namespace alhazen::impl::test

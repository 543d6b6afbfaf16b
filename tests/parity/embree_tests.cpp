// Embree answers ray queries like our own BVH, so the images are nearly equal. The tests are skipped if Embree is not
// built in.

#include "parity/scenes.h"

#if defined(ALHAZEN_WITH_EMBREE)

#include <limits>

#include "backends/embree/module/intersector.h"
#include "backends/embree/module/scene.h"
#include "core/bvh/brute_force/intersector.h"
#include "support/closed_meshes.h"
#include "support/instanced_scenes.h"
#include "support/primitive_scenes.h"
#include "support/ulps.h"

namespace alhazen::impl::test {
namespace {

using test::Random;

Ray<float> random_ray(Random& random, double size) {
  const Vec3d origin = random.in_box(-size, size);
  const Vec3d direction =
      random.uniform<double>() < 0.5 ? random.on_sphere() : normalize(random.in_box(-0.5, 0.5) * size - origin);
  return {convert<float>(origin), normalize(convert<float>(direction)), random.uniform<float>()};
}

void expect_what_looking_at_every_primitive_finds(const CompiledScene<float>& scene, size_t rays) {
  const EmbreeScene embree(scene.view, 1);
  const EmbreeIntersector intersector(scene.view, embree.tracer());
  const BruteForceIntersector<float> brute_force(scene.view);
  Random random(8);
  size_t hit_count = 0, different = 0;
  for (size_t i = 0; i < rays; ++i) {
    const Ray<float> ray = random_ray(random, 15);
    Hit<float> hit, expected;
    const bool found = intersector.closest_hit(ray, infinity<float>, hit);
    const bool expect_found = brute_force.closest_hit(ray, infinity<float>, expected);
    hit_count += found;
    // Rays that graze an edge may differ: the triangle tests round differently.
    if (found != expect_found ||
        (found && (!(hit.primitive == expected.primitive) || hit.instance != expected.instance))) {
      ++different;
      continue;
    }
    EXPECT_EQ(intersector.occluded(ray, infinity<float>), found);
    if (found) {
      EXPECT_NEAR(hit.t, expected.t, 1e-4f * expected.t + 1e-5f);
    }
    if (found && hit.primitive.kind() != PrimitiveKind::triangle) {
      EXPECT_EQ(hit.t, expected.t);  // both use the same sphere test
    }
    if (found && expected.t > 1e-3f) {
      EXPECT_FALSE(intersector.occluded(ray, expected.t * 0.999f));
    }
  }
  EXPECT_GT(hit_count, rays / 5);
  EXPECT_LE(different, 1 + rays / 10'000);
}

TEST(Embree, HitsWhatTheLinearScanFinds) {
  expect_what_looking_at_every_primitive_finds(test::mixed_primitives(7, 200).flat<float>(), 50'000);
}

TEST(Embree, HitsInstances) {
  const CompiledScene<float> scene = test::flat_instanced_scene<float>(test::instanced_scene(5, 80, 10), false);
  ASSERT_EQ(scene.view.instances_count, 80u);
  expect_what_looking_at_every_primitive_finds(scene, 5'000);
}

TEST(Embree, IsNotHurtByNothing) {
  const CompiledScene<float> scene = test::PrimitiveScene().flat<float>();
  const EmbreeScene embree(scene.view, 1);
  const EmbreeIntersector intersector(scene.view, embree.tracer());
  Hit<float> hit;
  EXPECT_FALSE(intersector.closest_hit({{}, {0, 0, 1}}, infinity<float>, hit));
  EXPECT_FALSE(intersector.occluded({{}, {0, 0, 1}}, infinity<float>));
}

TEST(Embree, IsNotAskedAboutRaysOutOfItsRange) {
  const CompiledScene<float> scene = test::mixed_primitives(7, 50).flat<float>();
  const EmbreeScene embree(scene.view, 1);
  const EmbreeIntersector intersector(scene.view, embree.tracer());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float odd : {nan, infinity<float>, -infinity<float>, 1e19f, -3e38f})
    for (int place = 0; place < 7; ++place) {
      Ray<float> ray{{0, 0, -20}, {0, 0, 1}, 0};
      float* const numbers[] = {&ray.origin.x,    &ray.origin.y,    &ray.origin.z,
                                &ray.direction.x, &ray.direction.y, &ray.direction.z};
      float t_max = infinity<float>;
      if (place < 6)
        *numbers[place] = odd;
      else
        t_max = nan;
      Hit<float> hit;
      EXPECT_FALSE(intersector.closest_hit(ray, t_max, hit)) << odd << " in place " << place;
      EXPECT_FALSE(intersector.occluded(ray, t_max)) << odd << " in place " << place;
    }
}

TEST(Embree, RefusesWhatItWouldLeaveOut) {
  // Objects of 10^8 units, scaled down: points far away in the world are out of range in their space.
  for (const double distance : {1.0, 1e11}) {
    const Transform small = Transform::scale(Vec3d{1e-8, 1e-8, 1e-8}),
                    placed = Transform::translate({distance, 0, 0}) * small;
    Scene scene = test::instanced_scene(5, 3, 10);
    for (Mesh& mesh : scene.meshes)
      for (Vec3d& position : mesh.positions) position = position * 1e8;
    scene.groups[0].shapes[0].world_from_object = {small, small};
    for (Instance& instance : scene.instances) instance.world_from_group = {placed, placed};
    const CompiledScene<float> flat = test::flat_instanced_scene<float>(std::move(scene), false);
    ASSERT_EQ(flat.view.instances_count, 3u);
    if (distance > 1)
      EXPECT_THROW(EmbreeScene(flat.view, 1), InputError);
    else
      EXPECT_NO_THROW(EmbreeScene(flat.view, 1));
  }
}

TEST(Embree, ReportsItsMemory) {
  const CompiledScene<float> scene = test::mixed_primitives(3, 1000).flat<float>();
  EXPECT_GT(EmbreeScene(scene.view, 1).bytes(), 1000 * 64);
}

Settings settings_of(const std::string& backend) {
  Settings settings;
  settings.backend = backend;
  settings.precision = "float";
  settings.samples_per_pixel = 18;
  settings.aovs = all_aovs;
  return settings;
}

/// The same samples have the same values, except for few paths that diverge because a hit is rounded differently.
class EmbreeImage : public ::testing::TestWithParam<std::string> {};

TEST_P(EmbreeImage, IsThatOfTheSerialBackend) {
  const Scene& scene = parity_scene(GetParam());
  const Outcome serial = render_bits(scene, settings_of("serial")), embree = render_bits(scene, settings_of("embree"));
  ASSERT_EQ(serial.rows.size(), embree.rows.size());
  EXPECT_EQ(serial.statistics.camera_samples, embree.statistics.camera_samples);
  size_t alike = 0;
  double sum = 0, expected_sum = 0;
  for (size_t i = 0; i < serial.rows.size(); ++i) {
    const double a = static_cast<double>(embree.rows[i]), b = static_cast<double>(serial.rows[i]);
    alike += std::abs(a - b) <= 2e-3 * std::abs(b) + 1e-4;
    sum += std::isfinite(a) ? a : 0;
    expected_sum += std::isfinite(b) ? b : 0;
  }
  EXPECT_GT(static_cast<double>(alike), 0.95 * static_cast<double>(serial.rows.size()));
  EXPECT_NEAR(sum, expected_sum, 0.01 * std::abs(expected_sum));
  EXPECT_EQ(embree.statistics.nonfinite_samples, 0u);
}

TEST_P(EmbreeImage, IsTheSameBitsByEveryStrategyAndThreadCount) {
  const Scene& scene = parity_scene(GetParam());
  Settings settings = settings_of("embree");
  settings.threads = 1;
  const Outcome expected = render_bits(scene, settings);
  for (const char* strategy : {"tiles", "rows", "collapse", "rows+reduction", "reduction"})
    for (const int threads : {1, 2, 3}) {
      settings.strategy = strategy;
      settings.threads = threads;
      EXPECT_TRUE(same_bits(expected, render_bits(scene, settings))) << strategy << " on " << threads;
    }
}

INSTANTIATE_TEST_SUITE_P(Parity, EmbreeImage, ::testing::Values("cornell", "spheres", "cylinders", "disks"));

TEST(Embree, TracesInFloatAlone) {
  Settings settings = settings_of("embree");
  settings.precision = "double";
  EXPECT_THROW(render_bits(parity_scene("cornell"), settings), InputError);
}

}  // namespace
}  // namespace alhazen::impl::test

#else

TEST(Embree, HitsWhatTheLinearScanFinds) { GTEST_SKIP() << "this build is without Embree"; }

#endif

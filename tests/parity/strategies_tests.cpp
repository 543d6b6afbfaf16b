// The image does not depend on which thread renders which part of it: serial, and every OpenMP strategy, schedule and
// thread count, give the same bits.

#include "parity/scenes.h"

namespace alhazen::impl::test {

namespace {

const std::vector<std::string> strategies{"tiles", "rows", "collapse", "rows+reduction", "reduction"};
const std::vector<std::string> schedules{"static",    "static,3", "dynamic", "dynamic,1",
                                         "dynamic,7", "guided",   "guided,2"};
const std::vector<int> thread_counts{1, 2, 3, 8};

/// Two passes, the second of which ends within a block.
constexpr int64_t samples = 18;

/// A serial render of the whole image, and of a part of it for the strategies that start a team of threads for every
/// pixel, which takes long if there are more threads than processors.
struct Expected {
  Settings settings, part_settings;
  Outcome whole, part;

  Expected(const Scene& scene, const Settings& serial) : settings(serial), part_settings(serial) {
    part_settings.pixel_bounds = {{9, 17, 3, 9}};
    whole = render_bits(scene, settings);
    part = render_bits(scene, part_settings);
  }
  bool is_part(const std::string& strategy) const { return strategy == "reduction" || strategy == "rows+reduction"; }
};

Settings serial_settings(const std::string& precision) {
  Settings settings;
  settings.backend = "serial";
  settings.precision = precision;
  settings.samples_per_pixel = samples;
  settings.aovs = all_aovs;
  return settings;
}

void expect_same(const Scene& scene, const Expected& expected, const std::string& strategy, const std::string& schedule,
                 int threads) {
  SCOPED_TRACE(strategy + " " + schedule + " on " + std::to_string(threads) + " threads");
  const Outcome& serial = expected.is_part(strategy) ? expected.part : expected.whole;
  Settings settings = expected.is_part(strategy) ? expected.part_settings : expected.settings;
  settings.backend = "openmp";
  settings.strategy = strategy;
  settings.schedule = schedule;
  settings.threads = threads;
  const Outcome outcome = render_bits(scene, settings);
  EXPECT_TRUE(same_bits(serial, outcome));
  EXPECT_EQ(outcome.statistics.threads.size(), static_cast<size_t>(threads));
  EXPECT_EQ(outcome.statistics.camera_samples, serial.statistics.camera_samples);
  EXPECT_EQ(outcome.statistics.rays, serial.statistics.rays);
  EXPECT_EQ(outcome.statistics.shadow_rays, serial.statistics.shadow_rays);
}

/// Scene and precision.
using SceneAndPrecision = std::tuple<std::string, std::string>;
class EverySchedule : public ::testing::TestWithParam<SceneAndPrecision> {};

TEST_P(EverySchedule, OfEveryStrategyGivesTheSerialBits) {
  const auto& [name, precision] = GetParam();
  const Scene& scene = parity_scene(name);
  const Expected expected(scene, serial_settings(precision));
  EXPECT_EQ(expected.whole.statistics.samples_per_pixel, samples);
  for (const std::string& strategy : strategies)
    for (const std::string& schedule : schedules) expect_same(scene, expected, strategy, schedule, 3);
}

INSTANTIATE_TEST_SUITE_P(Parity, EverySchedule,
                         ::testing::Combine(::testing::Values("cornell", "spheres"),
                                            ::testing::Values("float", "double")));

/// Scene, precision, integrator, sampler.
using Kernel = std::tuple<std::string, std::string, std::string, std::string>;
class EveryKernel : public ::testing::TestWithParam<Kernel> {};

TEST_P(EveryKernel, GivesTheSerialBitsByEveryStrategyAndThreadCount) {
  const auto& [name, precision, integrator, sampler] = GetParam();
  const Scene& scene = parity_scene(name);
  Settings serial = serial_settings(precision);
  serial.integrator = integrator;
  serial.sampler = sampler;
  const Expected expected(scene, serial);
  size_t next = 0;
  for (const std::string& strategy : strategies)
    for (const int threads : thread_counts)
      expect_same(scene, expected, strategy, schedules[next++ % schedules.size()], threads);
}

INSTANTIATE_TEST_SUITE_P(Parity, EveryKernel,
                         ::testing::Combine(::testing::Values("cornell", "spheres"),
                                            ::testing::Values("float", "double"),
                                            ::testing::Values("path", "iterative", "recursive", "branching"),
                                            ::testing::Values("sobol", "zsobol", "independent")));

void expect_same_by_every_strategy(const std::string& scene) {
  for (const std::string precision : {"float", "double"})
    for (const std::string integrator : {"path", "iterative", "recursive", "branching"}) {
      Settings serial = serial_settings(precision);
      serial.integrator = integrator;
      const Expected expected(parity_scene(scene), serial);
      for (const std::string& strategy : strategies)
        expect_same(parity_scene(scene), expected, strategy, "dynamic,1", 2);
    }
}

TEST(Parity, EnvironmentMapsByEveryStrategy) { expect_same_by_every_strategy("environments"); }
TEST(Parity, MaterialsByEveryStrategy) { expect_same_by_every_strategy("materials"); }
TEST(Parity, CylindersByEveryStrategy) { expect_same_by_every_strategy("cylinders"); }
TEST(Parity, DisksByEveryStrategy) { expect_same_by_every_strategy("disks"); }
TEST(Parity, ManyLightsByEveryStrategy) { expect_same_by_every_strategy("lights"); }

TEST(Parity, TheSceneShowsEverythingThatItIsMadeFor) {
  // Black images would also have the same bits.
  for (const std::string scene :
       {"cornell", "spheres", "environments", "lights", "materials", "instances", "cylinders", "disks"}) {
    const Outcome outcome = render_bits(parity_scene(scene), serial_settings("float"));
    const size_t width = static_cast<size_t>(outcome.width), row = width * outcome.channels.size();
    for (size_t c = 0; c < outcome.channels.size(); ++c) {
      const std::string& channel = outcome.channels[c];
      if (channel == "samples.Y" || channel == "alpha.Y" || channel.starts_with("motion") ||
          channel.starts_with("Crypto"))
        continue;  // they may be alike everywhere
      float low = infinity<float>, high = -infinity<float>;
      for (size_t first = c * width; first < outcome.rows.size(); first += row) {
        const auto [least, most] = std::minmax_element(&outcome.rows[first], &outcome.rows[first] + width);
        low = std::min(low, *least);
        high = std::max(high, *most);
      }
      EXPECT_LT(low, high) << scene << " " << outcome.channels[c];
    }
    EXPECT_EQ(outcome.statistics.nonfinite_samples, 0u);
  }
}

TEST(Parity, SeedsSamplersAndIntegratorsDiffer) {
  Settings settings = serial_settings("float");
  const Outcome first = render_bits(parity_scene("spheres"), settings);
  EXPECT_TRUE(same_bits(first, render_bits(parity_scene("spheres"), settings)));
  settings.seed = 1;
  EXPECT_FALSE(same_bits(first, render_bits(parity_scene("spheres"), settings)));
  settings.seed = 0x80000000u;
  EXPECT_FALSE(same_bits(first, render_bits(parity_scene("spheres"), settings)));
  settings.seed.reset();
  settings.sampler = "independent";
  EXPECT_FALSE(same_bits(first, render_bits(parity_scene("spheres"), settings)));
  settings.sampler.clear();
  settings.integrator = "iterative";
  EXPECT_FALSE(same_bits(first, render_bits(parity_scene("spheres"), settings)));
}

}  // namespace

}  // namespace alhazen::impl::test

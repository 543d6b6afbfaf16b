// Path guiding: what is learned does not depend on the order of samples, so the image has the same bits with any
// engine, size of passes and interruption; and the mean over many images is that of renders without guiding.

#include <algorithm>
#include <cmath>

#include "parity/scenes.h"
#include "support/effort.h"
#include "support/statistics.h"

namespace alhazen::test {

namespace {

/// Enough samples for two guided iterations of so small an image, the last of them incomplete.
constexpr int64_t two_iterations = 1101;

Settings guided_settings(const std::string& precision, int64_t samples = two_iterations) {
  Settings settings;
  settings.backend = "serial";
  settings.precision = precision;
  settings.samples_per_pixel = samples;
  settings.guiding = "on";
  settings.width = 11;
  settings.height = 9;
  return settings;
}

/// Of radiance.
double mean_of(const Outcome& outcome) {
  const size_t channels = outcome.channels.size(), width = static_cast<size_t>(outcome.width);
  double sum = 0;
  for (size_t y = 0; y < static_cast<size_t>(outcome.height); ++y)
    for (size_t x = 0; x < 3 * width; ++x) sum += static_cast<double>(outcome.rows[y * channels * width + x]);
  return sum / (3 * static_cast<double>(outcome.width) * outcome.height);
}

class Guided : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  const Scene& scene() const { return parity_scene(std::get<0>(GetParam())); }
  const std::string& precision() const { return std::get<1>(GetParam()); }
};

TEST_P(Guided, HasTheSameBitsByAllEngines) {
  Settings settings = guided_settings(precision());
  settings.aovs = all_aovs;
  const Outcome expected = render_bits(scene(), settings);
  EXPECT_TRUE(expected.statistics.guiding.is_used);
  EXPECT_EQ(expected.statistics.guiding.iterations, 1u);
  EXPECT_GT(expected.statistics.guiding.regions, 1u);
  const auto expect_same = [&](const Settings& other) {
    SCOPED_TRACE(other.backend + " " + other.strategy + " " + other.schedule);
    const Outcome outcome = render_bits(scene(), other);
    EXPECT_TRUE(same_bits(expected, outcome));
    EXPECT_EQ(outcome.statistics.guiding.regions, expected.statistics.guiding.regions);
    EXPECT_EQ(outcome.statistics.guiding.gain, expected.statistics.guiding.gain);
  };
  Settings other = settings;
  other.backend = "openmp";
  for (const auto& [strategy, schedule, threads] : {std::tuple{"tiles", "dynamic", 2},
                                                    {"rows", "static", 3},
                                                    {"collapse", "dynamic,3", 2},
                                                    {"rows+reduction", "guided,2", 2},
                                                    {"reduction", "static", 3}}) {
    other.strategy = strategy;
    other.schedule = schedule;
    other.threads = threads;
    expect_same(other);
  }
  other = settings;
  other.backend = "cuda";
  other.device = "host";
  for (const char* strategy : {"pixel", "chunk", "persistent", "wavefront"}) {
    other.strategy = strategy;
    expect_same(other);
  }
  other = settings;
  other.time_limit = 1e6;  // other sizes of passes
  expect_same(other);
}

TEST_P(Guided, ResumesWithTheSameBits) {
  const TemporaryFolder folder;
  for (const auto& [before, after] : {std::pair<int64_t, int64_t>{100, 600}, {256, 700}, {516, 1101}, {1024, 1030}}) {
    SCOPED_TRACE(std::to_string(before) + " samples, then " + std::to_string(after));
    const Outcome expected = render_bits(scene(), guided_settings(precision(), after));
    Settings settings = guided_settings(precision(), before);
    settings.checkpoint = folder.file("state");
    settings.overwrite = true;
    render_bits(scene(), settings);
    settings.overwrite = false;
    settings.resume = true;
    settings.samples_per_pixel = after;
    settings.backend = "openmp";
    EXPECT_TRUE(same_bits(render_bits(scene(), settings), expected));
  }
}

TEST_P(Guided, ResumesAfterBeingStopped) {
  const TemporaryFolder folder;
  constexpr int64_t samples = 20'000;
  Settings settings = guided_settings(precision(), samples);
  settings.threads = 2;
  settings.backend = "openmp";
  const Outcome expected = render_bits(scene(), settings);
  settings.checkpoint = folder.file("state");
  for (int stop = 0; stop < 2; ++stop) {
    int calls = 0;
    const Outcome part = render_bits(scene(), settings, [&](const Progress&) { return ++calls < 3; });
    ASSERT_TRUE(part.statistics.interrupted) << "the machine is too fast for this test: give it more samples";
    settings.resume = true;
  }
  EXPECT_TRUE(same_bits(render_bits(scene(), settings), expected));
}

/// With adaptive sampling, whose decisions see the iterations, and with the halves that denoising needs.
TEST_P(Guided, WorksWithANoiseTargetAndADenoiser) {
  Settings settings = guided_settings(precision(), 3000);
  settings.noise = 0.05;
  settings.denoiser = "builtin";
  const Outcome expected = render_bits(scene(), settings);
  EXPECT_EQ(expected.statistics.denoiser, "builtin");
  EXPECT_LT(expected.statistics.noise.mean_samples, 3000);
  settings.backend = "openmp";
  settings.threads = 3;
  EXPECT_TRUE(same_bits(render_bits(scene(), settings), expected));
}

INSTANTIATE_TEST_SUITE_P(Parity, Guided,
                         ::testing::Combine(::testing::Values("cornell", "materials"),
                                            ::testing::Values("float", "double")));

class GuidedMean : public ::testing::TestWithParam<std::string> {};

TEST_P(GuidedMean, IsThatWithoutGuiding) {
  Moments guided, plain;
  for (uint32_t seed = 0; seed < effort(8); ++seed) {
    Settings settings = guided_settings("float", 1024);
    settings.seed = seed;
    guided.add(mean_of(render_bits(parity_scene(GetParam()), settings)));
    settings.seed = 1000 + seed;
    settings.guiding = "off";
    plain.add(mean_of(render_bits(parity_scene(GetParam()), settings)));
  }
  EXPECT_GT(welch_p_value(guided, plain, 1e-5 * plain.mean()), 0.002)
      << guided.mean() << " +- " << guided.standard_error() << " with, " << plain.mean() << " +- "
      << plain.standard_error() << " without";
}

INSTANTIATE_TEST_SUITE_P(Parity, GuidedMean,
                         ::testing::Values("cornell", "spheres", "environments", "lights", "materials", "meshes"));

/// A closed white surface that emits 1: paths of 5 segments give 1 + a + ... + a^4.
TEST(GuidedFurnace, KeepsEnergy) {
  const Scene scene = scene_of(R"(Film "rgb" "integer xresolution" 16 "integer yresolution" 16
Camera "perspective" "float fov" 90
WorldBegin
Material "diffuse" "rgb reflectance" [ 0.8 0.8 0.8 ]
AreaLightSource "diffuse" "rgb L" [ 1 1 1 ] "bool twosided" true
Translate 0.3 -0.2 0.1
Shape "sphere" "float radius" 2
)");
  for (const char* precision : {"float", "double"}) {
    Settings settings = guided_settings(precision, 1024);
    settings.max_depth = 4;
    const Outcome outcome = render_bits(scene, settings);
    EXPECT_TRUE(outcome.statistics.guiding.is_used);
    EXPECT_NEAR(mean_of(outcome), (1 - std::pow(0.8, 5)) / 0.2, 0.005);
  }
}

TEST(GuidedLimits, DarkScenesAndTinyImages) {
  Scene dark = scene_of(R"(Film "rgb" "integer xresolution" 16 "integer yresolution" 16
Camera "perspective" "float fov" 90
WorldBegin
LightSource "point" "rgb I" [ 1 1 1 ]
Shape "sphere" "float radius" 2
)");
  dark.lights.front().radiance = {};
  Settings settings = guided_settings("float");
  const Outcome black = render_bits(dark, settings);
  EXPECT_EQ(mean_of(black), 0);
  EXPECT_FALSE(black.statistics.guiding.is_used);
  settings.pixel_bounds = {{3, 5, 4, 5}};  // two pixels
  const Outcome tiny = render_bits(parity_scene("cornell"), settings);
  EXPECT_TRUE(std::all_of(tiny.rows.begin(), tiny.rows.end(), [](float value) { return std::isfinite(value); }));
  settings.guiding = "auto";
  settings.samples_per_pixel = 64;  // too few for anything to be decided
  EXPECT_FALSE(render_bits(parity_scene("cornell"), settings).statistics.guiding.is_used);
}

TEST(GuidedLimits, MemoryIsKept) {
  Settings settings = guided_settings("float", 4096);
  settings.guiding_memory = 1;
  const Outcome outcome = render_bits(parity_scene("materials"), settings);
  EXPECT_LE(outcome.statistics.guiding.bytes, 1u << 20);
  EXPECT_GT(outcome.statistics.guiding.regions, 1u);
}

}  // namespace

}  // namespace alhazen::test

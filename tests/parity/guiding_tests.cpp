// Path guiding: what is learned does not depend on the order of samples, so the image has the same bits with any
// engine, size of passes and interruption; and the mean over many images is that of renders without guiding.

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "parity/engines.h"
#include "parity/scenes.h"
#include "support/effort.h"
#include "support/statistics.h"

namespace alhazen::impl::test {

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

/// Red of all pixels of a row, then green, then blue, and so on for each row.
std::vector<double> radiance_of(const Outcome& outcome) {
  const size_t channels = outcome.channels.size(), width = static_cast<size_t>(outcome.width);
  std::vector<double> values;
  for (size_t y = 0; y < static_cast<size_t>(outcome.height); ++y)
    for (size_t x = 0; x < 3 * width; ++x)
      values.push_back(static_cast<double>(outcome.rows[y * channels * width + x]));
  return values;
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double mean_of(const Outcome& outcome) { return mean_of(radiance_of(outcome)); }

/// The mean square of the differences, in a pixel relative to its value and a tenth of the mean.
double error_of(const Outcome& outcome, const std::vector<double>& expected) {
  const std::vector<double> values = radiance_of(outcome);
  const double mean = mean_of(expected);
  double sum = 0;
  for (size_t i = 0; i < values.size(); ++i) sum += sqr((values[i] - expected[i]) / (expected[i] + 0.1 * mean));
  return sum / static_cast<double>(values.size());
}

/// An image with hardly any noise, made without guiding.
const std::vector<double>& reference_image(const std::string& scene) {
  static std::map<std::string, std::vector<double>> images;
  std::vector<double>& image = images[scene];
  if (image.empty()) {
    Settings settings = guided_settings("float", 8192);
    settings.backend = "openmp";
    settings.guiding = "off";
    settings.seed = 77;
    image = radiance_of(render_bits(parity_scene(scene), settings));
  }
  return image;
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
  EXPECT_EQ(expected.statistics.guiding.iterations, 2u);
  EXPECT_GT(expected.statistics.guiding.regions, 1u);
  const auto expect_same = [&](const Settings& other) {
    SCOPED_TRACE(other.backend + " " + other.strategy + " " + other.schedule);
    const Outcome outcome = render_bits(scene(), other);
    EXPECT_TRUE(same_bits(expected, outcome));
    EXPECT_EQ(outcome.statistics.guiding.regions, expected.statistics.guiding.regions);
    EXPECT_EQ(outcome.statistics.guiding.gain, expected.statistics.guiding.gain);
  };
  visit_engines(settings, expect_same);
}

TEST_P(Guided, ResumesWithTheSameBits) {
  const TemporaryFolder folder;
  for (const auto& [guiding, before, after] : {std::tuple<std::string, int64_t, int64_t>{"on", 100, 600},
                                               {"on", 256, 700},
                                               {"on", 516, 1101},
                                               {"on", 1024, 1030},
                                               {"auto", 32, 2100},
                                               {"auto", 1024, 1400}}) {
    SCOPED_TRACE(guiding + ", " + std::to_string(before) + " samples, then " + std::to_string(after));
    Settings settings = guided_settings(precision(), after);
    settings.guiding = guiding;
    const Outcome expected = render_bits(scene(), settings);
    settings.samples_per_pixel = before;
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

/// Samples of an iteration that has just begun have the weight that they deserve, not more.
TEST_P(Guided, IsAsGoodJustAfterAnIterationAsBeforeIt) {
  for (const int64_t end : {512, 1024}) {
    const auto error = [&](int64_t samples) {
      return error_of(render_bits(scene(), guided_settings(precision(), samples)),
                      reference_image(std::get<0>(GetParam())));
    };
    const double before = error(end);
    for (const int64_t more : {1, 2, 5, 16}) {
      SCOPED_TRACE(std::to_string(end) + " samples and " + std::to_string(more));
      EXPECT_LT(error(end + more), 1.1 * before);
    }
  }
}

TEST_P(Guided, VarianceIsKnownWhereAnIterationEnds) {
  for (const int64_t samples : {256, 512, 1024, 1025, 1030}) {
    SCOPED_TRACE(samples);
    Settings settings = guided_settings(precision(), samples);
    settings.aovs = {"variance"};
    const Outcome outcome = render_bits(scene(), settings);
    const size_t width = static_cast<size_t>(outcome.width);
    ASSERT_EQ(outcome.channels.size(), 4u);
    size_t known = 0;
    for (size_t y = 0; y < static_cast<size_t>(outcome.height); ++y)
      for (size_t x = 0; x < width; ++x) known += outcome.rows[(4 * y + 3) * width + x] > 0;
    EXPECT_GT(known, outcome.rows.size() / 4 / 2);
  }
}

/// Also of pixels that were finished in an earlier iteration.
TEST_P(Guided, VarianceIsKnownOfFinishedPixels) {
  Settings settings = guided_settings(precision(), 20'000);
  settings.noise = 0.05;
  settings.aovs = {"variance"};
  const Outcome outcome = render_bits(scene(), settings);
  const size_t width = static_cast<size_t>(outcome.width);
  size_t known = 0;
  for (size_t y = 0; y < static_cast<size_t>(outcome.height); ++y)
    for (size_t x = 0; x < width; ++x) known += outcome.rows[(4 * y + 3) * width + x] > 0;
  EXPECT_GT(known, outcome.rows.size() / 4 / 2);
}

/// A noise target is met as well as without guiding, also where it finishes all pixels in the middle of an iteration.
TEST_P(Guided, MeetsANoiseTarget) {
  for (const double noise : {0.06, 0.03}) {
    SCOPED_TRACE(noise);
    Settings settings = guided_settings(precision(), 20'000);
    settings.noise = noise;
    const auto error = [&](const char* guiding) {
      settings.guiding = guiding;
      const Outcome outcome = render_bits(scene(), settings);
      EXPECT_LT(outcome.statistics.noise.mean_samples, 20'000);
      return std::sqrt(error_of(outcome, reference_image(std::get<0>(GetParam()))));
    };
    EXPECT_LT(error("on"), 1.3 * std::max(noise, error("off")));
  }
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

/// The names of parity scenes, and two more.
const Scene& guided_scene(const std::string& name) {
  if (name == "negative weights") {
    static const Scene filtered = [] {
      Scene scene = parity_scene("materials");
      scene.filter = {FilterType::mitchell, 2, 2};
      return scene;
    }();
    return filtered;
  }
  if (name == "motion") {
    static const Scene moving = scene_of(R"(LookAt 0 -5 2  0 0 0.4  0 0 1
Camera "perspective" "float fov" 45
Film "rgb" "integer xresolution" 20 "integer yresolution" 17
WorldBegin
AttributeBegin Translate 0 0 3 AreaLightSource "diffuse" "rgb L" [ 4 4 4 ] Shape "sphere" "float radius" 0.5 AttributeEnd
Shape "trianglemesh" "point3 P" [ -9 -9 0  9 -9 0  9 9 0  -9 9 0 ] "integer indices" [ 0 1 2 0 2 3 ]
AttributeBegin ActiveTransform EndTime Translate 1 0 0.5 ActiveTransform All
Translate -0.5 0 0.5 Shape "sphere" "float radius" 0.5 AttributeEnd
AttributeBegin Material "conductor" "float roughness" 0.2 Translate 1 1 0.7 Shape "sphere" "float radius" 0.7 AttributeEnd
)");
    return moving;
  }
  return parity_scene(name);
}

class GuidedMean : public ::testing::TestWithParam<std::string> {};

/// Over two guided iterations and a part of a third; shares of the BSDF are learned from the second on.
TEST_P(GuidedMean, IsThatWithoutGuiding) {
  Moments guided, plain;
  for (uint32_t seed = 0; seed < std::max(size_t{4}, effort(8)); ++seed) {
    Settings settings = guided_settings("float", 2304);
    settings.backend = "openmp";
    settings.seed = seed;
    const Outcome outcome = render_bits(guided_scene(GetParam()), settings);
    EXPECT_EQ(outcome.statistics.guiding.iterations, 3u);
    guided.add(mean_of(outcome));
    settings.seed = 1000 + seed;
    settings.guiding = "off";
    plain.add(mean_of(render_bits(guided_scene(GetParam()), settings)));
  }
  EXPECT_GT(welch_p_value(guided, plain, 1e-5 * plain.mean()), 0.002)
      << guided.mean() << " +- " << guided.standard_error() << " with, " << plain.mean() << " +- "
      << plain.standard_error() << " without";
}

INSTANTIATE_TEST_SUITE_P(Parity, GuidedMean,
                         ::testing::Values("cornell", "spheres", "environments", "lights", "materials", "meshes",
                                           "negative weights", "motion"));

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
    Settings settings = guided_settings(precision, 2304);
    settings.max_depth = 4;
    const Outcome outcome = render_bits(scene, settings);
    EXPECT_TRUE(outcome.statistics.guiding.is_used);
    EXPECT_NEAR(mean_of(outcome), (1 - std::pow(0.8, 5)) / 0.2, 0.005);
  }
}

TEST(GuidedLimits, DarkScenes) {
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
}

/// Too few pixels to compare variances in some iterations.
TEST(GuidedLimits, TinyImages) {
  for (const int64_t samples : {256, 513, 600, 2049, 5000}) {
    SCOPED_TRACE(samples);
    Settings settings = guided_settings("float", samples);
    settings.pixel_bounds = {{3, 5, 4, 5}};  // two pixels
    const std::vector<double> guided = radiance_of(render_bits(parity_scene("cornell"), settings));
    settings.guiding = "off";
    settings.samples_per_pixel = 32'768;
    const std::vector<double> plain = radiance_of(render_bits(parity_scene("cornell"), settings));
    ASSERT_EQ(guided.size(), 6u);
    for (size_t i = 0; i < guided.size(); ++i) EXPECT_NEAR(guided[i], plain[i], 0.1 * plain[i] + 0.01);
  }
}

TEST(GuidedLimits, MemoryIsKept) {
  Settings settings = guided_settings("float", 4097);
  settings.backend = "openmp";
  const auto guiding = [&](int64_t memory) {
    settings.guiding_memory = memory;
    return render_bits(parity_scene("materials"), settings).statistics.guiding;
  };
  const GuidingState enough = guiding(256), little = guiding(1);
  // The old arrays and the new ones exist at once, in vectors that grow by doubling.
  constexpr uint64_t part = (1 << 20) / 5;
  ASSERT_GT(enough.bytes, part) << "one MiB would do";
  EXPECT_LE(little.bytes, part);
  EXPECT_GT(little.regions, 1u);
  EXPECT_LT(little.regions, enough.regions);
}

}  // namespace

}  // namespace alhazen::impl::test

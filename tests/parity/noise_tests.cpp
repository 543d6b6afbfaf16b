// A noise target: which pixels get samples depends on the film alone, so the image has the same bits with any engine,
// size of passes and interruption; and the mean over many images is that of renders without one.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "parity/engines.h"
#include "parity/scenes.h"
#include "render/noise.h"

namespace alhazen::impl::test {

namespace {

Settings noise_settings(const std::string& precision, double noise, int64_t most) {
  Settings settings;
  settings.backend = "serial";
  settings.precision = precision;
  settings.noise = noise;
  settings.samples_per_pixel = most;
  settings.width = 37;
  settings.height = 29;
  settings.aovs = {"samples"};
  return settings;
}

/// One channel of the image, in rows.
std::vector<float> plane_of(const Outcome& outcome, const std::string& name) {
  const size_t channels = outcome.channels.size(), width = static_cast<size_t>(outcome.width);
  const size_t channel =
      static_cast<size_t>(std::find(outcome.channels.begin(), outcome.channels.end(), name) - outcome.channels.begin());
  std::vector<float> plane;
  for (size_t y = 0; y < static_cast<size_t>(outcome.height); ++y) {
    const auto row = outcome.rows.begin() + static_cast<std::ptrdiff_t>((y * channels + channel) * width);
    plane.insert(plane.end(), row, row + static_cast<std::ptrdiff_t>(width));
  }
  return plane;
}

double mean_of(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

class Noise : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  const Scene& scene() const { return parity_scene(std::get<0>(GetParam())); }
  const std::string& precision() const { return std::get<1>(GetParam()); }
};

TEST_P(Noise, HasTheSameBitsByAllEngines) {
  for (const char* measure : {"relative", "display"}) {
    SCOPED_TRACE(measure);
    Settings settings = noise_settings(precision(), 0.15, 99);  // ends within a block
    settings.noise_measure = measure;
    if (settings.noise_measure == "display") settings.noise = 0.04;
    settings.aovs = all_aovs;
    const Outcome expected = render_bits(scene(), settings);
    const std::vector<float> samples = plane_of(expected, "samples.Y");
    ASSERT_LT(*std::min_element(samples.begin(), samples.end()), *std::max_element(samples.begin(), samples.end()));
    const auto expect_same = [&](const Settings& other) {
      SCOPED_TRACE(other.backend + " " + other.strategy + " " + other.schedule);
      const Outcome outcome = render_bits(scene(), other);
      EXPECT_TRUE(same_bits(expected, outcome));
      EXPECT_EQ(outcome.statistics.camera_samples, expected.statistics.camera_samples);
      EXPECT_EQ(outcome.statistics.noise.noise, expected.statistics.noise.noise);
    };
    visit_engines(settings, expect_same);
  }
}

TEST_P(Noise, ResumesWithTheSameBits) {
  const TemporaryFolder folder;
  for (const auto& [before, after] : {std::pair{16, 99}, {20, 64}, {4, 48}, {30, 80}, {80, 80}}) {
    SCOPED_TRACE(std::to_string(before) + " samples at most, then " + std::to_string(after));
    const Outcome expected = render_bits(scene(), noise_settings(precision(), 0.15, after));
    Settings settings = noise_settings(precision(), 0.15, before);
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

TEST_P(Noise, ResumesAfterBeingStopped) {
  const TemporaryFolder folder;
  constexpr int64_t most = 3000;
  Settings settings = noise_settings(precision(), 0.02, most);
  const Outcome expected = render_bits(scene(), settings);
  settings.checkpoint = folder.file("state");
  double samples = 0;
  for (int stop = 0; stop < 3; ++stop) {
    const Outcome part = render_bits(scene(), settings, [](const Progress&) { return false; });
    ASSERT_TRUE(part.statistics.interrupted);
    ASSERT_FALSE(part.statistics.complete);
    EXPECT_LT(part.statistics.samples_per_pixel, most);
    const double taken = mean_of(plane_of(part, "samples.Y"));
    EXPECT_GT(taken, samples);
    samples = taken;
    settings.resume = true;
  }
  EXPECT_TRUE(same_bits(render_bits(scene(), settings), expected));
}

TEST_P(Noise, RefusesToResumeWithAnotherTarget) {
  const TemporaryFolder folder;
  Settings settings = noise_settings(precision(), 0.15, 16);
  settings.checkpoint = folder.file("state");
  render_bits(scene(), settings);
  settings.resume = true;
  const auto message = [&](double noise, const char* measure) {
    settings.noise = noise;
    settings.noise_measure = measure;
    try {
      render_bits(scene(), settings);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("not refused");
  };
  EXPECT_NE(message(0.1, "").find("it was written with noise 0.15 relative, and this render has noise 0.1 relative"),
            std::string::npos);
  EXPECT_NE(message(0, "").find("it was written with noise 0.15 relative, and this render has none of that"),
            std::string::npos);
  EXPECT_NE(message(0.15, "display").find("displayed"), std::string::npos);
  EXPECT_EQ(message(0.15, "relative"), "not refused");
}

/// A target that no noisy pixel reaches changes no bit of the image.
TEST_P(Noise, TakesTheMostSamplesAtMost) {
  for (const int64_t most : {1, 7, 16, 42}) {
    SCOPED_TRACE(most);
    Settings settings = noise_settings(precision(), 1e-9, most);
    settings.aovs = {"variance"};  // whose planes the target uses too
    const Outcome outcome = render_bits(scene(), settings);
    EXPECT_TRUE(outcome.statistics.complete);
    settings.noise = 0;
    const Outcome uniform = render_bits(scene(), settings);
    EXPECT_EQ(outcome.statistics.samples_per_pixel, static_cast<uint32_t>(most));
    // Pixels without any noise are finished, and keep their value.
    size_t differing = 0;
    for (size_t i = 0; i < uniform.rows.size(); ++i) differing += std::abs(outcome.rows[i] - uniform.rows[i]) > 1e-5f;
    EXPECT_EQ(differing, 0u);
  }
}

TEST_P(Noise, OfOnePixelAndOfAPart) {
  Settings settings = noise_settings(precision(), 0.3, 200);
  settings.width = settings.height = 1;
  const Outcome pixel = render_bits(scene(), settings);
  EXPECT_TRUE(pixel.statistics.complete);
  settings = noise_settings(precision(), 0.3, 200);
  settings.crop_window = {{0.25, 0.5, 0.5, 1}};
  const Outcome part = render_bits(scene(), settings);
  EXPECT_TRUE(part.statistics.complete);
  settings.backend = "openmp";
  settings.threads = 2;
  EXPECT_TRUE(same_bits(part, render_bits(scene(), settings)));
}

/// A denoiser changes what is shown, and neither which pixels get samples nor what they are.
TEST_P(Noise, TogetherWithADenoiser) {
  Settings settings = noise_settings(precision(), 0.15, 99);
  const Outcome noisy = render_bits(scene(), settings);
  settings.denoiser = "builtin";
  settings.aovs = {"samples", "noisy"};
  const Outcome denoised = render_bits(scene(), settings);
  EXPECT_EQ(denoised.statistics.denoiser, "builtin");
  EXPECT_EQ(plane_of(denoised, "samples.Y"), plane_of(noisy, "samples.Y"));
  EXPECT_EQ(plane_of(denoised, "noisy.G"), plane_of(noisy, "G"));
  EXPECT_NE(plane_of(denoised, "G"), plane_of(noisy, "G"));
  EXPECT_EQ(denoised.statistics.noise.noise, noisy.statistics.noise.noise);

  Settings other = settings;
  other.backend = "openmp";
  other.threads = 2;
  EXPECT_TRUE(same_bits(denoised, render_bits(scene(), other)));

  const TemporaryFolder folder;
  other.checkpoint = folder.file("state");
  other.samples_per_pixel = 32;
  render_bits(scene(), other);
  other.resume = true;
  other.samples_per_pixel = 99;
  EXPECT_TRUE(same_bits(denoised, render_bits(scene(), other)));
}

/// Too few samples for an estimate: the error of every pixel counts as 1, and none is below the target.
TEST_P(Noise, OfFourSamplesIsNotKnown) {
  const Outcome outcome = render_bits(scene(), noise_settings(precision(), 0.5, 4));
  EXPECT_TRUE(outcome.statistics.complete);
  EXPECT_EQ(outcome.statistics.noise.noise, 1);
  EXPECT_EQ(outcome.statistics.noise.below, 0);
  EXPECT_EQ(outcome.statistics.noise.mean_samples, 4);
}

/// Also of a render that is resumed, whose first pass must be small.
TEST_P(Noise, KeepsATimeLimit) {
  const TemporaryFolder folder;
  for (const double noise : {0.0, 1e-9}) {
    SCOPED_TRACE(noise);
    Settings settings = noise_settings(precision(), noise, 64);
    settings.checkpoint = folder.file("state");
    settings.overwrite = true;
    render_bits(scene(), settings);
    settings.overwrite = false;
    settings.resume = true;
    settings.samples_per_pixel = 1 << 24;
    settings.time_limit = 0.3;
    const RenderStatistics statistics = render_bits(scene(), settings).statistics;
    EXPECT_LT(statistics.render_seconds, 1.5);
    EXPECT_GT(statistics.mean_samples, 64);
    EXPECT_FALSE(statistics.interrupted);
    EXPECT_FALSE(statistics.complete);
  }
}

INSTANTIATE_TEST_SUITE_P(Parity, Noise,
                         ::testing::Combine(::testing::Values("cornell", "spheres"),
                                            ::testing::Values("float", "double")));

/// A lit floor in the lower half of the image and nothing in the upper one.
Scene half_black() {
  return scene_of(R"(LookAt 0 -5 2  0 0 2  0 0 1
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 64 "integer yresolution" 64
WorldBegin
AttributeBegin Translate 0 2 40 AreaLightSource "diffuse" "rgb L" [ 400 400 400 ]
Shape "sphere" "float radius" 2 AttributeEnd
Shape "trianglemesh" "point3 P" [ -90 -90 0  90 -90 0  90 90 0  -90 90 0 ] "integer indices" [ 0 1 2 0 2 3 ]
)");
}

TEST(NoiseTarget, SendsSamplesToTheNoisyHalf) {
  Settings settings = noise_settings("float", 0.05, 512);
  settings.width = settings.height = 64;
  settings.integrator = "iterative";  // finds the lamp by chance
  const std::vector<float> samples = plane_of(render_bits(half_black(), settings), "samples.Y");
  const auto row_mean = [&](size_t y) {
    return mean_of({samples.begin() + static_cast<std::ptrdiff_t>(64 * y),
                    samples.begin() + static_cast<std::ptrdiff_t>(64 * (y + 1))});
  };
  for (size_t y = 0; y < 12; ++y) EXPECT_EQ(row_mean(y), 16) << y;
  for (size_t y = 40; y < 64; ++y) EXPECT_GT(row_mean(y), 400) << y;
}

TEST(NoiseTarget, StopsEarlyWhereThereIsNoNoise) {
  const Scene sky = scene_of(R"(Film "rgb" "integer xresolution" 20 "integer yresolution" 17
WorldBegin
LightSource "infinite" "rgb L" [ 0.1 0.2 0.3 ]
)");
  const Outcome outcome = render_bits(sky, noise_settings("float", 1e-3, 4096));
  EXPECT_TRUE(outcome.statistics.complete);
  EXPECT_EQ(outcome.statistics.samples_per_pixel, 16u);
  EXPECT_EQ(outcome.statistics.noise.below, 1);
  EXPECT_EQ(outcome.statistics.noise.mean_samples, 16);
}

TEST(NoiseTarget, DecidesAtFixedNumbersOfSamples) {
  EXPECT_EQ(next_decision(0), 16u);
  EXPECT_EQ(next_decision(15), 16u);
  EXPECT_EQ(next_decision(16), 24u);
  for (uint32_t n = 16; n < 100000; n = next_decision(n)) {
    EXPECT_EQ(n % 8, 0u);
    EXPECT_EQ(next_decision(n - 1), n);
    if (n >= 32) {
      EXPECT_LE(next_decision(n), n + n / 4) << n;
    }
  }
}

TEST(NoiseTarget, MustBeAPositiveNumber) {
  for (const double wrong : {-0.1, 1.5, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_THROW(render_bits(half_black(), noise_settings("float", wrong, 16)), InputError) << wrong;
  Settings settings = noise_settings("float", 0.1, 16);
  settings.noise_measure = "absolute";
  EXPECT_THROW(render_bits(half_black(), settings), InputError);
}

/// A pixel alone has only its own samples to decide by. Where they miss what is rare it stops too early, and where they
/// happen to be bright its relative error looks small; both within bounds.
TEST(NoiseTarget, StopsASinglePixelAboutWhereItShould) {
  constexpr int seeds = 400;
  struct OfSeeds {
    double mean = 0, variance = 0, samples = 0;
  };
  const auto of_seeds = [&](double noise, int64_t samples) {
    Settings settings = noise_settings("float", noise, samples);
    settings.sampler = "independent";
    settings.pixel_bounds = {{18, 19, 20, 21}};
    OfSeeds of;
    double squares = 0;
    for (uint32_t seed = 0; seed < seeds; ++seed) {
      settings.seed = seed + (noise > 0 ? 0 : 100000);
      const Outcome outcome = render_bits(parity_scene("cornell"), settings);
      const double value = mean_of(plane_of(outcome, "G"));
      of.mean += value / seeds;
      squares += value * value / seeds;
      of.samples += static_cast<double>(plane_of(outcome, "samples.Y")[0]) / seeds;
    }
    of.variance = squares - of.mean * of.mean;
    return of;
  };
  constexpr double target = 0.2;
  const OfSeeds adaptive = of_seeds(target, 512), uniform = of_seeds(0, 64);
  const double expected = 64 * uniform.variance / (uniform.mean * uniform.mean) / (target * target);
  EXPECT_NEAR(adaptive.mean / uniform.mean, 1, target);
  EXPECT_GT(adaptive.samples / expected, 0.5) << "expected " << expected;
  EXPECT_LT(adaptive.samples / expected, 1.3) << "expected " << expected;
  RecordProperty("bias", std::to_string(adaptive.mean / uniform.mean - 1));
  RecordProperty("samples_over_expected", std::to_string(adaptive.samples / expected));
  RecordProperty("error", std::to_string(std::sqrt(adaptive.variance) / uniform.mean));
}

/// The mean over 64 seeds, for tiles of the image and all of it, against many samples of every pixel. A mean that is
/// biased by stopping where samples happen to be dark would be found by the whole image's Z, which is that of a million
/// samples.
TEST(NoiseTarget, DoesNotBiasTheMean) {
  for (const std::string name : {"cornell", "spheres"}) {
    SCOPED_TRACE(name);
    constexpr int seeds = 64;
    const auto means = [&](double noise, int64_t samples) {
      std::vector<double> of_seeds;
      for (uint32_t seed = 0; seed < seeds; ++seed) {
        Settings settings = noise_settings("float", noise, samples);
        settings.seed = seed + (noise > 0 ? 0 : 1000);
        const Outcome outcome = render_bits(parity_scene(name), settings);
        of_seeds.push_back((mean_of(plane_of(outcome, "R")) + mean_of(plane_of(outcome, "G"))) / 2);
      }
      const double mean = std::accumulate(of_seeds.begin(), of_seeds.end(), 0.0) / seeds;
      double squares = 0;
      for (const double value : of_seeds) squares += (value - mean) * (value - mean);
      return std::pair{mean, squares / (seeds - 1) / seeds};
    };
    const auto [adaptive, variance] = means(0.2, 512);
    const auto [uniform, uniform_variance] = means(0, 64);
    EXPECT_LT(std::abs(adaptive - uniform) / std::sqrt(variance + uniform_variance), 2.576);
  }
}

}  // namespace

}  // namespace alhazen::impl::test

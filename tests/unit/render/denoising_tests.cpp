// The built-in denoiser, what is common to all denoisers, and Open Image Denoise over a mock of its library.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "core/film/film_view.h"
#include "core/sampling/hash.h"
#include "render/denoiser.h"
#include "render/denoising/blend.h"
#include "render/denoising/builtin.h"
#include "render/noisy_image.h"
#include "support/environment_variable.h"
#include "util/diagnostics.h"

namespace alhazen::impl {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Uniform in [-1, 1).
float noise_of(uint64_t i) { return static_cast<float>(mix64(i) >> 40) / static_cast<float>(1 << 23) - 1; }

struct Pixel {
  float radiance[3], albedo[3], normal[3], depth;
};

using Picture = std::function<Pixel(int x, int y)>;

/// Each sample of a pixel differs from the picture by up to `amplitude` of it.
NoisyImage noisy_image(int width, int height, uint32_t samples, float amplitude, const Picture& picture) {
  NoisyImage image;
  image.width = width;
  image.height = height;
  const size_t pixels = image.pixels();
  for (NoisyBuffer* buffer : {&image.radiance, &image.albedo, &image.normal})
    for (std::vector<float>* values : {&buffer->mean, &buffer->odd}) values->resize(3 * pixels);
  image.depth.mean.resize(pixels);
  image.depth.odd.resize(pixels);
  image.variance.resize(pixels);
  image.samples.assign(pixels, samples);
  image.hits.assign(pixels, 1);
  const uint32_t odd_samples = samples_in_odd_blocks(samples);
  image.odd_fraction.assign(pixels, static_cast<float>(odd_samples) / static_cast<float>(samples));
  for (size_t i = 0; i < pixels; ++i) {
    const Pixel pixel = picture(static_cast<int>(i) % width, static_cast<int>(i) / width);
    double sum = 0, odd_sum = 0, squares = 0;
    for (uint32_t s = 0; s < samples; ++s) {
      const double factor = 1 + static_cast<double>(amplitude) * static_cast<double>(noise_of(i * 100003 + s));
      sum += factor;
      squares += factor * factor;
      if (s / samples_per_block % 2 == 1) odd_sum += factor;
    }
    const double mean = sum / samples, odd = odd_samples > 0 ? odd_sum / odd_samples : 0;
    const float light = 0.2126f * pixel.radiance[0] + 0.7152f * pixel.radiance[1] + 0.0722f * pixel.radiance[2];
    for (size_t c = 0; c < 3; ++c) {
      image.radiance.mean[3 * i + c] = pixel.radiance[c] * static_cast<float>(mean);
      image.radiance.odd[3 * i + c] = pixel.radiance[c] * static_cast<float>(odd);
      image.albedo.mean[3 * i + c] = image.albedo.odd[3 * i + c] = pixel.albedo[c];
      image.normal.mean[3 * i + c] = image.normal.odd[3 * i + c] = pixel.normal[c];
    }
    image.depth.mean[i] = image.depth.odd[i] = pixel.depth;
    if (samples > 1)
      image.variance[i] = light * light * static_cast<float>(std::max(0.0, squares - sum * mean) / (samples - 1));
  }
  return image;
}

double error_of(const std::vector<float>& values, int width, const Picture& picture) {
  double sum = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    const int pixel = static_cast<int>(i / 3);
    const double difference = static_cast<double>(values[i] - picture(pixel % width, pixel / width).radiance[i % 3]);
    sum += difference * difference;
  }
  return std::sqrt(sum / static_cast<double>(values.size()));
}

std::vector<float> denoised(const NoisyImage& image, int threads = 2) {
  return denoise("builtin", image, {0, threads});
}

Pixel grey_wall(float radiance, float albedo) {
  return {{radiance, radiance, radiance}, {albedo, albedo, albedo}, {0, 0, 1}, 5};
}

/// A wall on which light falls off.
Pixel smooth_wall(int x, int y) {
  return grey_wall(0.5f + 0.004f * static_cast<float>(x) - 0.002f * static_cast<float>(y), 0.5f);
}

/// Squares of 5 pixels, two greys.
Pixel checkerboard(int x, int y) {
  const float albedo = (x / 5 + y / 5) % 2 == 0 ? 0.2f : 0.8f;
  return grey_wall(albedo, albedo);
}

/// Light that no feature explains.
Pixel striped_light(int x, int y) { return grey_wall(1 + 0.3f * std::sin(static_cast<float>(3 * x + y)), 0.5f); }

TEST(BuiltinDenoiser, ConstantImageStays) {
  const Picture constant = [](int, int) { return grey_wall(0.7f, 0.5f); };
  for (const float value : denoised(noisy_image(40, 30, 16, 0, constant))) ASSERT_NEAR(value, 0.7f, 1e-5f);
}

TEST(BuiltinDenoiser, ReducesNoise) {
  const NoisyImage image = noisy_image(64, 48, 16, 1, smooth_wall);
  const double before = error_of(image.radiance.mean, 64, smooth_wall),
               after = error_of(denoised(image), 64, smooth_wall);
  EXPECT_LT(after, before / 6) << before;
}

TEST(BuiltinDenoiser, KeepsEdgesOfAlbedo) {
  const NoisyImage image = noisy_image(60, 60, 16, 1, checkerboard);
  const double before = error_of(image.radiance.mean, 60, checkerboard);
  const std::vector<float> result = denoised(image);
  EXPECT_LT(error_of(result, 60, checkerboard), before / 4) << before;
  for (int y = 1; y < 59; ++y)
    for (int x = 1; x < 59; ++x)
      ASSERT_NEAR(result[static_cast<size_t>(3 * (y * 60 + x))], checkerboard(x, y).radiance[0], 0.15f)
          << x << " " << y;
}

TEST(BuiltinDenoiser, GivesTheSameBitsForAnyThreads) {
  const NoisyImage image = noisy_image(150, 90, 12, 1, checkerboard);
  const std::vector<float> one = denoised(image, 1);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(denoised(image, threads), one) << threads;
}

TEST(BuiltinDenoiser, TakesImagesOfAnySize) {
  for (const auto& [width, height] : {std::pair(1, 1), {1, 40}, {40, 1}, {2, 3}})
    for (const uint32_t samples : {1u, 2u, 4u, 5u, 64u}) {
      const std::vector<float> result = denoised(noisy_image(width, height, samples, 0.5f, smooth_wall));
      ASSERT_EQ(result.size(), static_cast<size_t>(3 * width * height));
      for (const float value : result) ASSERT_TRUE(value > 0 && value < 4) << width << "x" << height << ": " << value;
    }
}

TEST(BuiltinDenoiser, HasNoSeamsBetweenTiles) {
  const Picture constant = [](int, int) { return grey_wall(0.7f, 0.5f); };
  for (const float value : denoised(noisy_image(530, 5, 16, 0, constant))) ASSERT_NEAR(value, 0.7f, 1e-5f);
}

/// Edges of albedo and of light, and a normal that turns, over the whole image.
Pixel varied_wall(int x, int y) {
  Pixel pixel = checkerboard(x, y);
  const float light = ((x + y) / 17 % 2 == 0 ? 0.4f : 1.6f) + 0.01f * static_cast<float>(x);
  for (float& channel : pixel.radiance) channel *= light;
  // Not linear in x and y, with which the regression would have no single solution.
  pixel.normal[0] = 0.5f * std::sin(0.13f * static_cast<float>(x));
  pixel.depth = 5 + 0.5f * std::cos(0.09f * static_cast<float>(y));
  return pixel;
}

TEST(BuiltinDenoiser, TilesGiveWhatOneTileGives) {
  const NoisyImage image = noisy_image(150, 70, 16, 1, varied_wall);
  const denoising::Kernels kernels = denoising::select_kernels();
  const std::vector<float> whole = denoising::denoise_in_tiles(image, 512, kernels, 2);
  EXPECT_LT(error_of(whole, 150, varied_wall), error_of(image.radiance.mean, 150, varied_wall) / 1.5);
  for (const int size : {64, 61}) {
    const std::vector<float> tiled = denoising::denoise_in_tiles(image, size, kernels, 2);
    for (size_t i = 0; i < whole.size(); ++i)
      ASSERT_NEAR(tiled[i], whole[i], 1e-4f) << "pixel " << i / 3 % 150 << " " << i / 3 / 150;
  }
}

TEST(BuiltinDenoiser, InstructionSetsGiveTheSameBits) {
  const std::vector<denoising::Kernels> kernels = denoising::all_kernels();
  if (kernels.size() < 2) GTEST_SKIP() << "one instruction set is here";
  const NoisyImage image = noisy_image(70, 50, 16, 1, varied_wall);
  const std::vector<float> best = denoising::denoise_in_tiles(image, 512, kernels.back(), 2);
  for (const denoising::Kernels& others : kernels) EXPECT_EQ(denoising::denoise_in_tiles(image, 512, others, 2), best);
}

TEST(Denoising, ScaleOfTheRadianceDoesNotMatter) {
  const NoisyImage image = noisy_image(60, 50, 16, 1, varied_wall);
  const std::vector<float> result = denoised(image);
  for (const float scale : {1e-3f, 1e3f, 1e-9f, 0x1p10f, 0x1p-10f}) {
    NoisyImage scaled = image;
    for (std::vector<float>* values : {&scaled.radiance.mean, &scaled.radiance.odd})
      for (float& value : *values) value *= scale;
    for (float& value : scaled.variance) value *= scale * scale;
    const std::vector<float> of_scaled = denoised(scaled);
    // Rounding may change which of two estimates is better, where both are as good.
    const float error = scale == 0x1p10f || scale == 0x1p-10f ? 0.0f : 1e-3f;
    for (size_t i = 0; i < result.size(); ++i)
      ASSERT_NEAR(of_scaled[i] / scale, result[i], error) << scale << " times, pixel " << i / 3;
  }
}

TEST(BuiltinDenoiser, RemovesFireflies) {
  NoisyImage image = noisy_image(41, 41, 16, 0.5f, smooth_wall);
  const size_t pixel = 20 * 41 + 20;
  for (size_t c = 0; c < 3; ++c) {
    image.radiance.mean[3 * pixel + c] += 1000;
    image.radiance.odd[3 * pixel + c] += 2000;
  }
  image.variance[pixel] = 16e6f;
  for (const float value : denoised(image)) ASSERT_LT(value, 3);
}

TEST(BuiltinDenoiser, ReplacesWhatIsNotFinite) {
  NoisyImage image = noisy_image(30, 30, 16, 0.5f, smooth_wall);
  image.radiance.mean[3 * 400] = nan;
  image.radiance.odd[3 * 401] = std::numeric_limits<float>::infinity();
  image.albedo.mean[3 * 402] = nan;
  image.normal.odd[3 * 403] = nan;
  image.depth.mean[404] = std::numeric_limits<float>::infinity();
  image.variance[405] = nan;
  for (const float value : denoised(image)) ASSERT_TRUE(value > 0 && value < 4) << value;
  NoisyImage broken = noisy_image(3, 3, 16, 0, smooth_wall);
  for (float& value : broken.radiance.mean) value = nan;
  EXPECT_EQ(denoising::repair(broken), 9u);
  for (const float value : broken.radiance.mean) EXPECT_EQ(value, 0);
}

TEST(BuiltinDenoiser, MixesHalvesByTheirSamples) {
  NoisyImage image = noisy_image(30, 30, 16, 0, [](int, int) { return grey_wall(1, 0.5f); });
  image.odd_fraction.assign(image.pixels(), 0.25f);
  std::fill(image.radiance.mean.begin(), image.radiance.mean.end(), 1.25f);
  std::fill(image.radiance.odd.begin(), image.radiance.odd.end(), 2.0f);  // the even half is 1
  for (const float value : make_denoiser("builtin")->denoise(image, {0, 2})) ASSERT_NEAR(value, 1.25f, 1e-4f);
}

TEST(Denoising, PixelsWithoutSamplesDoNotCount) {
  NoisyImage image = noisy_image(40, 40, 16, 0.3f, smooth_wall);
  for (int y = 10; y < 16; ++y)
    for (int x = 12; x < 17; ++x) {
      const size_t i = static_cast<size_t>(y * 40 + x);
      image.samples[i] = 0;
      image.hits[i] = image.variance[i] = image.odd_fraction[i] = 0;
      for (NoisyBuffer* buffer : {&image.radiance, &image.albedo, &image.normal, &image.depth})
        for (std::vector<float>* values : {&buffer->mean, &buffer->odd}) {
          const size_t channels = buffer == &image.depth ? 1 : 3;
          std::fill_n(values->begin() + static_cast<std::ptrdiff_t>(channels * i), channels, 0.0f);
        }
    }
  const std::vector<float> result = denoised(image);
  for (int y = 5; y < 21; ++y)
    for (int x = 7; x < 22; ++x)
      ASSERT_NEAR(result[static_cast<size_t>(3 * (y * 40 + x))], smooth_wall(x, y).radiance[0], 0.05f) << x << " " << y;
  std::fill(image.samples.begin(), image.samples.end(), 0u);
  std::fill(image.odd_fraction.begin(), image.odd_fraction.end(), 0.0f);
  for (const float value : denoised(image)) ASSERT_TRUE(std::isfinite(value));
}

TEST(Denoising, IsNeverWorseThanNoiseWithMoreSamples) {
  for (const uint32_t samples : {8u, 64u, 512u, 4096u}) {
    const NoisyImage image = noisy_image(48, 48, samples, 1, striped_light);
    const double before = error_of(image.radiance.mean, 48, striped_light);
    EXPECT_LT(error_of(denoised(image), 48, striped_light), 1.05 * before) << samples;
  }
}

TEST(Denoising, ABadDenoiserDoesNoHarmInTheEnd) {
  for (const uint32_t samples : {64u, 1024u, 16384u}) {
    const NoisyImage image = noisy_image(20, 20, samples, 1, smooth_wall);
    std::vector<float> black(3 * image.pixels());
    denoising::blend_with_noisy(image, black, 2);
    EXPECT_LT(error_of(black, 20, smooth_wall), 1.1 * error_of(image.radiance.mean, 20, smooth_wall)) << samples;
  }
}

/// Two blocks in one pixel whose filter weights, of four samples each, sum to these.
NoisyImage two_blocks(float even_weight, float odd_weight) {
  Film<float> film({0, 1, 0, 1}, {}, {true, false, true});
  for (const float weight : {even_weight, odd_weight}) {
    BlockSum<float> block;
    block.begin(false);
    block.samples = 4;
    block.weight = weight;
    block.radiance = Vec3<float>{1, 2, 3} * (weight * (weight == odd_weight ? 2.0f : 1.0f));
    film.add(0, 0, block);
  }
  return make_noisy_image(film);
}

TEST(Denoising, HalvesHaveTheirOwnFilterWeights) {
  const NoisyImage image = two_blocks(4, 2);
  EXPECT_FLOAT_EQ(image.odd_fraction[0], 1.0f / 3);
  EXPECT_FLOAT_EQ(image.radiance.odd[2], 6);
  EXPECT_FLOAT_EQ(image.radiance.mean[2], 4);
  for (const float none : {0.0f, -2.0f}) {
    EXPECT_EQ(two_blocks(4, none).odd_fraction[0], 0);
    EXPECT_EQ(two_blocks(none, 4).odd_fraction[0], 0);
  }
}

TEST(Denoising, ChoosesByName) {
  EXPECT_EQ(choose_denoiser("").name, "");
  EXPECT_EQ(choose_denoiser("none").name, "");
  EXPECT_EQ(choose_denoiser("builtin").name, "builtin");
  EXPECT_FALSE(choose_denoiser("auto").name.empty());
  EXPECT_THROW(choose_denoiser("blur"), InputError);
}

using test::EnvironmentVariable;

TEST(OidnDenoiser, FiltersFeaturesFirst) {
  const NoisyImage image = noisy_image(5, 4, 8, 0.5f, checkerboard);
  for (const char* folder : {ALHAZEN_MOCK_OIDN_1, ALHAZEN_MOCK_OIDN_2}) {
    const EnvironmentVariable path("ALHAZEN_OIDN_PATH", folder);
    const auto denoiser = make_denoiser("oidn");
    ASSERT_EQ(denoiser->problem(), "");
    const std::vector<float> result = denoiser->denoise(image, {});
    for (size_t i = 0; i < result.size(); ++i)
      ASSERT_EQ(result[i], image.radiance.mean[i] + (image.albedo.mean[i] + 1) + 2 * (image.normal.mean[i] + 1))
          << folder;
  }
}

TEST(OidnDenoiser, RunsOnTheThreadsAskedFor) {
  const EnvironmentVariable wanted("MOCK_OIDN_WANTS_THREADS", "3");
  for (const std::string folder : {ALHAZEN_MOCK_OIDN_1, ALHAZEN_MOCK_OIDN_2}) {
    const EnvironmentVariable path("ALHAZEN_OIDN_PATH", folder);
    const NoisyImage image = noisy_image(2, 2, 8, 0, checkerboard);
    EXPECT_NO_THROW(make_denoiser("oidn")->denoise(image, {0, 3})) << folder;
    EXPECT_THROW(make_denoiser("oidn")->denoise(image, {0, 2}), RenderError) << folder;
  }
}

TEST(OidnDenoiser, ReportsErrors) {
  const EnvironmentVariable path("ALHAZEN_OIDN_PATH", ALHAZEN_MOCK_OIDN_2), fails("MOCK_OIDN_FAILS", "1");
  try {
    make_denoiser("oidn")->denoise(noisy_image(2, 2, 8, 0, checkerboard), {});
    FAIL();
  } catch (const RenderError& error) {
    EXPECT_STREQ(error.what(), "Open Image Denoise failed while filtering the albedo: the mock fails");
  }
}

TEST(OidnDenoiser, NamesAWrongLibrary) {
  for (const std::string file : {"/nowhere/at/all", "/etc/passwd", "/usr"}) {
    const EnvironmentVariable path("ALHAZEN_OIDN_PATH", file);
    const auto denoiser = make_denoiser("oidn");
    EXPECT_EQ(denoiser->problem().rfind(file, 0), 0u) << denoiser->problem();
    EXPECT_EQ(denoiser->defect(), denoiser->problem());
    const ChosenDenoiser chosen = choose_denoiser("auto");
    if (chosen.name == "optix") continue;
    EXPECT_EQ(chosen.name, "builtin");
    EXPECT_NE(chosen.warning.find(file), std::string::npos) << chosen.warning;
    EXPECT_THROW(choose_denoiser("oidn"), UnsupportedError);
  }
}

}  // namespace
}  // namespace alhazen::impl

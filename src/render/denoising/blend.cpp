#include "render/denoising/blend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "render/denoising/tile.h"

namespace alhazen::impl::denoising {

namespace {

/// What the mean of a pixel is expected to differ from the truth by, squared, and by what it differs from the denoised
/// one, relative to its brightness.
struct Differences {
  float of_noise = 0, of_images = 0;
};

Differences differences_at(const NoisyImage& noisy, const std::vector<float>& denoised, size_t i) {
  const float odd_fraction = noisy.odd_fraction[i];
  // Whose noise is not known does not count.
  if (odd_fraction == 0) return {};
  Differences sums;
  float scale = 1e-12f;
  for (size_t c = 3 * i; c < 3 * i + 3; ++c) {
    const float mean = noisy.radiance.mean[c], odd = noisy.radiance.odd[c];
    // With halves a and b of fractions f and 1 - f, a - b has the variance s / f + s / (1 - f) if s is that of the
    // mean.
    const float between_halves = (odd - mean) / (1 - odd_fraction);
    sums.of_noise += between_halves * between_halves * odd_fraction * (1 - odd_fraction);
    sums.of_images += (mean - denoised[c]) * (mean - denoised[c]);
    scale += denoised[c] * denoised[c];
  }
  // A firefly must not decide for all pixels around it.
  const float weight = 1 / (scale + sums.of_noise + sums.of_images);
  return {sums.of_noise * weight, sums.of_images * weight};
}

/// The variance of a channel of the noisy mean, by its halves.
float variance_at(const NoisyImage& noisy, size_t i, size_t channel) {
  const float odd_fraction = noisy.odd_fraction[i];
  if (odd_fraction == 0) return 0;
  const float between_halves =
      (noisy.radiance.odd[3 * i + channel] - noisy.radiance.mean[3 * i + channel]) / (1 - odd_fraction);
  return between_halves * between_halves * odd_fraction * (1 - odd_fraction);
}

/// The sum of the squared weights of blur(), which is how much less noise the mean has.
float noise_of_blur(int radius) {
  const float side = static_cast<float>((radius + 1) * (radius + 1));
  float energy = 0;
  for (int i = -radius; i <= radius; ++i) {
    const float weight = static_cast<float>(radius + 1 - std::abs(i)) / side;
    energy += weight * weight;
  }
  return energy * energy;
}

/// A denoiser that smooths too much changes means over some pixels by more than the noise of such means. That part of
/// the difference is given back, shrunk as James and Stein (1961) do. Differences are relative to the brightness, so
/// that bright pixels do not decide for dark ones beside them, and limited, so that fireflies do not.
void restore_means(const NoisyImage& noisy, std::vector<float>& denoised, int radius, int threads) {
  constexpr float margin = 1, largest = 4;
  const int width = noisy.width, height = noisy.height, pooling = std::max(4, radius);
  const auto pixel = [&](int x, int y) {
    return static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
  };
  const auto each_pixel = [&](const auto& work) {
#pragma omp parallel for schedule(static) num_threads(threads)
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) work(x, y, pixel(x, y));
  };
  std::array<TilePlane, 3> means;
  TilePlane found(width, height), expected(width, height), variance(width, height), brightness(width, height);
  const auto light = [&](size_t i) { return denoised[3 * i] + denoised[3 * i + 1] + denoised[3 * i + 2]; };
  each_pixel([&](int x, int y, size_t i) { brightness.row(y)[x] = light(i); });
  blur(brightness, radius, threads);
  each_pixel([&](int x, int y, size_t i) {
    float& value = brightness.row(y)[x];
    value = 0.7f * light(i) + 0.3f * value + 1e-6f;
  });
  const float energy = noise_of_blur(radius);
  for (size_t c = 0; c < 3; ++c) {
    means[c] = TilePlane(width, height);
    each_pixel([&](int x, int y, size_t i) {
      const float scale = brightness.row(y)[x], difference = noisy.radiance.mean[3 * i + c] - denoised[3 * i + c];
      means[c].row(y)[x] = noisy.odd_fraction[i] > 0 ? std::clamp(difference / scale, -largest, largest) : 0;
      variance.row(y)[x] = std::min(variance_at(noisy, i, c) / (scale * scale), largest * largest);
    });
    blur(means[c], radius, threads);
    blur(variance, radius, threads);
    each_pixel([&](int x, int y, size_t) {
      const float of_noise = energy * variance.row(y)[x], mean = means[c].row(y)[x];
      const float weight = 1 / (of_noise + mean * mean + 1e-4f);
      found.row(y)[x] += mean * mean * weight;
      expected.row(y)[x] += of_noise * weight;
    });
  }
  blur(found, pooling, threads);
  blur(expected, pooling, threads);
  each_pixel([&](int x, int y, size_t i) {
    const float excess = found.row(y)[x] - margin * expected.row(y)[x];
    if (!(excess > 0)) return;
    const float part = excess / found.row(y)[x] * brightness.row(y)[x];
    for (size_t c = 0; c < 3; ++c)
      denoised[3 * i + c] = std::max(0.0f, denoised[3 * i + c] + part * means[c].row(y)[x]);
  });
}

}  // namespace

void blend_with_noisy(const NoisyImage& noisy, std::vector<float>& denoised, int threads) {
  // The larger the means, the less noise they have, and the more of them is restored.
  for (const int scale : {16, 8, 4, 2}) restore_means(noisy, denoised, scale, threads);
  constexpr int radius = 5;
  // If the denoised pixel has the squared error m, and the noisy one s, the images differ by m + s. The weight s / (m +
  // s) of the denoised one has the least error; the margin leaves no noise where it is good, since estimates vary.
  constexpr float margin = 1.5f;
  // Noise of about this part of the brightness is hardly seen, and what a denoiser changes there is.
  constexpr float visible = 0.03f;
  TilePlane of_noise(noisy.width, noisy.height), of_images(noisy.width, noisy.height);
  const size_t width = static_cast<size_t>(noisy.width);
  for (int y = 0; y < noisy.height; ++y)
    for (int x = 0; x < noisy.width; ++x) {
      const Differences d = differences_at(noisy, denoised, static_cast<size_t>(y) * width + static_cast<size_t>(x));
      of_noise.row(y)[x] = d.of_noise;
      of_images.row(y)[x] = d.of_images;
    }
  blur(of_noise, radius, threads);
  blur(of_images, radius, threads);
  for (int y = 0; y < noisy.height; ++y)
    for (int x = 0; x < noisy.width; ++x) {
      const float difference = of_images.row(y)[x];
      if (!(difference > 0)) continue;
      if (noisy.samples[static_cast<size_t>(y) * width + static_cast<size_t>(x)] == 0) continue;
      const float noise = of_noise.row(y)[x];
      const size_t i = 3 * (static_cast<size_t>(y) * width + static_cast<size_t>(x));
      float change = 0, scale = 1e-12f;
      for (size_t c = i; c < i + 3; ++c) {
        change += (noisy.radiance.mean[c] - denoised[c]) * (noisy.radiance.mean[c] - denoised[c]);
        scale += denoised[c] * denoised[c];
      }
      // A change that is seen, as of a firefly among pixels with little noise, is not taken back by this rule.
      const float seen = std::max(noise, change / scale);
      const float t = std::min(1.0f, margin * noise / difference) * seen / (seen + visible * visible);
      for (size_t c = 0; c < 3; ++c) {
        float& to = denoised[3 * (static_cast<size_t>(y) * width + static_cast<size_t>(x)) + c];
        const float from = noisy.radiance.mean[3 * (static_cast<size_t>(y) * width + static_cast<size_t>(x)) + c];
        to = from + t * (to - from);
      }
    }
}

namespace {

bool is_finite(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); });
}

/// Replaces the pixels of a buffer, which have `channels` values each.
size_t repair(std::vector<float>& values, size_t channels, size_t width, size_t height) {
  size_t count = 0;
  const auto pixel = [&](size_t x, size_t y) {
    return std::span<float>(values).subspan((y * width + x) * channels, channels);
  };
  for (size_t y = 0; y < height; ++y)
    for (size_t x = 0; x < width; ++x) {
      const std::span<float> broken = pixel(x, y);
      if (is_finite(broken)) continue;
      ++count;
      std::array<float, 3> sum{};
      float neighbours = 0;
      for (size_t j = y > 0 ? y - 1 : 0; j <= y + 1 && j < height; ++j)
        for (size_t i = x > 0 ? x - 1 : 0; i <= x + 1 && i < width; ++i)
          if (const std::span<float> near = pixel(i, j); is_finite(near)) {
            for (size_t c = 0; c < channels; ++c) sum[c] += near[c];
            ++neighbours;
          }
      for (size_t c = 0; c < channels; ++c) broken[c] = neighbours > 0 ? sum[c] / neighbours : 0;
    }
  return count;
}

}  // namespace

void fill_gaps(NoisyImage& image) {
  const int width = image.width, height = image.height;
  std::vector<size_t> missing, filled;
  std::vector<bool> is_known(image.pixels());
  for (size_t i = 0; i < is_known.size(); ++i) {
    is_known[i] = image.samples[i] > 0;
    if (!is_known[i]) missing.push_back(i);
  }
  const auto fill = [&](std::vector<float>& values, size_t channels, size_t i, const std::vector<size_t>& from) {
    for (size_t c = 0; c < channels; ++c) {
      float sum = 0;
      for (const size_t near : from) sum += values[channels * near + c];
      values[channels * i + c] = sum / static_cast<float>(from.size());
    }
  };
  std::vector<size_t> around;
  do {
    filled.clear();
    for (const size_t i : missing) {
      const int x = static_cast<int>(i % static_cast<size_t>(width)),
                y = static_cast<int>(i / static_cast<size_t>(width));
      around.clear();
      for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u)
          if (const size_t near = static_cast<size_t>(v) * static_cast<size_t>(width) + static_cast<size_t>(u);
              is_known[near])
            around.push_back(near);
      if (around.empty()) continue;
      for (NoisyBuffer* buffer : {&image.radiance, &image.albedo, &image.normal, &image.depth})
        for (std::vector<float>* values : {&buffer->mean, &buffer->odd})
          fill(*values, buffer == &image.depth ? 1 : 3, i, around);
      fill(image.hits, 1, i, around);
      filled.push_back(i);
    }
    for (const size_t i : filled) is_known[i] = true;
    std::erase_if(missing, [&](size_t i) { return is_known[i]; });
  } while (!filled.empty() && !missing.empty());
}

size_t repair(NoisyImage& image) {
  const size_t width = static_cast<size_t>(image.width), height = static_cast<size_t>(image.height);
  size_t count = 0;
  for (NoisyBuffer* buffer : {&image.radiance, &image.albedo, &image.normal, &image.depth})
    for (std::vector<float>* values : {&buffer->mean, &buffer->odd})
      count += repair(*values, buffer == &image.depth ? 1 : 3, width, height);
  return count + repair(image.variance, 1, width, height);
}

}  // namespace alhazen::impl::denoising

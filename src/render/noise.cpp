#include "render/noise.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <utility>

#include "images/display/exposure_meter.h"
#include "render/power_bisection.h"

namespace alhazen::impl {

namespace {

constexpr uint32_t first_decision = 16, decision_step = 2 * samples_per_block;

/// Means are taken over windows of 7 x 7 pixels, and over 3 x 3 tiles of 8 x 8.
constexpr int window_radius = 3, tile_size = 8;
/// The luminance to which errors are relative is at least this fraction of the image's mean luminance, for which the
/// brightest hundredth of the pixels is left out.
constexpr double dark_fraction = 0.1, bright_part = 0.01;
/// Bounds the ratio of both estimates of the variance, which is noisy. Where few pixels have most of it, this many of
/// them in which the estimates agree are added.
constexpr double min_gain = 0.05, agreeing_pixels = 10;
/// The variance of n samples is taken to fall as 1 / n^(1 + a) for an a below 1/4, of this many binary digits after its
/// first, 1/8.
constexpr int exponent_digits = 12;

/// The mean of `values` over the square of this radius around every pixel, or what of it is in the image.
std::vector<float> window_means(const std::vector<float>& values, int width, int height, int radius) {
  std::vector<float> rows(values.size()), means(values.size());
  const auto sum_along = [radius](const float* from, float* to, int count, size_t stride) {
    for (int i = 0; i < count; ++i) {
      const int first = std::max(0, i - radius), last = std::min(count - 1, i + radius);
      float sum = 0;
      for (int j = first; j <= last; ++j) sum += from[static_cast<size_t>(j) * stride];
      to[static_cast<size_t>(i) * stride] = sum / static_cast<float>(last - first + 1);
    }
  };
  const size_t row = static_cast<size_t>(width);
  for (size_t y = 0; y < static_cast<size_t>(height); ++y)
    sum_along(values.data() + y * row, rows.data() + y * row, width, 1);
  for (size_t x = 0; x < row; ++x) sum_along(rows.data() + x, means.data() + x, height, row);
  return means;
}

/// Sums over tiles, of which the last in each direction may be smaller.
class TileSums {
 public:
  /// `value(i)` is that of pixel i.
  template <class Value>
  TileSums(size_t pixels, int width, int height, const Value& value)
      : columns_((width + tile_size - 1) / tile_size), rows_((height + tile_size - 1) / tile_size) {
    sums_.resize(static_cast<size_t>(columns_) * static_cast<size_t>(rows_));
    const size_t row = static_cast<size_t>(width);
    for (size_t i = 0; i < pixels; ++i)
      sums_[index(static_cast<int>(i % row) / tile_size, static_cast<int>(i / row) / tile_size)] += value(i);
  }

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// Returns the sum of a tile and of those around it.
  double around(int column, int row) const {
    double sum = 0;
    for (int y = std::max(0, row - 1); y <= std::min(rows_ - 1, row + 1); ++y)
      for (int x = std::max(0, column - 1); x <= std::min(columns_ - 1, column + 1); ++x) sum += sums_[index(x, y)];
    return sum;
  }

 private:
  size_t index(int column, int row) const {
    return static_cast<size_t>(row) * static_cast<size_t>(columns_) + static_cast<size_t>(column);
  }

  int columns_, rows_;
  std::vector<double> sums_;
};

/// Blocks of a pixel, and how its samples are divided: the first 2^k blocks, of which there are fewer than all, and the
/// others.
struct Halves {
  explicit Halves(uint32_t samples) {
    blocks = (samples + samples_per_block - 1) / samples_per_block;
    first = std::bit_floor(blocks - 1) * samples_per_block;
    second = samples - first;
  }
  uint32_t blocks, first, second;
};

/// A pixel's luminance, and the variance of it by both estimates.
struct PixelMean {
  bool is_known = false;
  double luminance = 0, by_blocks = 0, by_halves = 0;
};

/// With guiding, of the last iteration.
template <class Real>
PixelMean mean_of_iteration(const FilmView<Real>& film, size_t i) {
  const uint32_t samples = film.current_samples(i);
  if (samples < 2 * samples_per_block) return {};
  const double n = samples;
  const Halves halves(samples);
  const double first = halves.first, second = halves.second;
  PixelMean mean;
  mean.is_known = true;
  mean.luminance = static_cast<double>(film.luminance_mean[i]);
  mean.by_blocks = static_cast<double>(film.block_m2[i]) / (n * (halves.blocks - 1));
  const double sum = mean.luminance * n, difference = static_cast<double>(film.half_difference[i]);
  const double of_means = (sum + difference) / 2 / first - (sum - difference) / 2 / second;
  mean.by_halves = of_means * of_means * first * second / (n * n);
  if (film.weights) {
    // The mean is a quotient of two sums over samples of weight 1 or -1. Its variance to first order is that of the
    // unweighted mean, divided by the square of the mean weight.
    const double weight = std::max(std::abs(static_cast<double>(film.weights[i])), 1e-3 * n);
    mean.luminance = static_cast<double>(luminance(film.radiance[i])) / weight;
    mean.by_blocks *= n * n / (weight * weight);
    mean.by_halves *= n * n / (weight * weight);
  }
  return mean;
}

/// Whether the last iteration, of guiding, is too short to estimate errors from: those of the ones before count.
template <class Real>
bool is_short(const FilmView<Real>& film, size_t i) {
  return film.earlier_samples && film.earlier_samples[i] > 0 && film.current_samples(i) < first_decision;
}

template <class Real>
PixelMean pixel_mean(const FilmView<Real>& film, size_t i) {
  PixelMean mean = mean_of_iteration(film, i);
  if (!film.earlier_variance || film.earlier_samples[i] == 0) return mean;
  const auto all = film.radiance_sum(i);
  mean.luminance = static_cast<double>(luminance(all.mean()));
  const double part =
      std::clamp(static_cast<double>(film.earlier_weights[i]) / static_cast<double>(all.weight), 0.0, 1.0);
  const double of_blocks = static_cast<double>(film.earlier_variance[i]),
               of_halves = static_cast<double>(film.earlier_half_variance[i]);
  if (is_short(film, i)) {
    // Whatever its few samples are like, they lower the variance about as much as others of their weight.
    mean.is_known = true;
    mean.by_blocks = of_blocks * part;
    mean.by_halves = of_halves * part;
  } else {
    mean.by_blocks = mean.by_blocks * sqr(1 - part) + of_blocks * sqr(part);
    mean.by_halves = mean.by_halves * sqr(1 - part) + of_halves * sqr(part);
  }
  return mean;
}

/// The number of samples of which the estimates of a pixel are.
template <class Real>
uint32_t estimated_samples(const FilmView<Real>& film, size_t i) {
  return is_short(film, i) ? film.earlier_samples[i] / 2 : film.current_samples(i);
}

/// The luminance to which the errors of darker pixels are relative.
template <class Real>
double darkest_luminance(const FilmView<Real>& film, size_t pixels) {
  std::vector<float> values(pixels);
  for (size_t i = 0; i < pixels; ++i) {
    const float value =
        static_cast<float>(film.earlier_weights ? luminance(film.radiance_sum(i).mean()) : film.luminance_mean[i]);
    values[i] = std::isfinite(value) ? value : 0;  // NaN has no order
  }
  const size_t counted = pixels - static_cast<size_t>(bright_part * static_cast<double>(pixels));
  std::vector<float> sorted = values;
  const auto limit = sorted.begin() + static_cast<std::ptrdiff_t>(counted - 1);
  std::nth_element(sorted.begin(), limit, sorted.end());
  // Values as large as the limit all count alike, so the sum does not depend on how they were ordered.
  double sum = 0;
  for (const float value : values) sum += static_cast<double>(std::min(value, *limit));
  return dark_fraction * sum / static_cast<double>(pixels);
}

/// The exposure of the image so far, as it would be displayed.
template <class Real>
double exposure_of(const FilmView<Real>& film, int width, int height, ExposureRule rule, bool has_alpha) {
  ExposureMeter meter(width, height, true);
  size_t i = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x, ++i) {
      const double coverage = static_cast<double>(film.coverage(i));
      const Vec3d radiance = convert<double>(film.radiance_sum(i).mean());
      meter.add(x, y, has_alpha && coverage > 0 ? radiance / coverage : radiance, coverage);
    }
  return meter.exposure(rule);
}

/// What the samples of some pixels are like, in the mean.
struct Division {
  double blocks, of_first, of_second;  ///< number of blocks; all samples over those of each half
};

/// Returns the variance of a mean as a multiple of what its blocks say, if `measured` is what its halves say as such a
/// multiple. With V(n) = c / n^(1 + a), errors within n samples cancel in part, so blocks see (B^(1 + a) - 1) / (B - 1)
/// times V(n), and halves of p and q samples (n / p)^a + (n / q)^a - 1 times. Their quotient gives a.
double variance_ratio(double measured, const Division& division) {
  PowerBisection first(division.of_first), second(division.of_second), blocks(division.blocks);
  for (int i = 0; i < exponent_digits; ++i) {
    const double of_halves = first.next() + second.next() - 1;
    const double of_blocks = (division.blocks * blocks.next() - 1) / (division.blocks - 1);
    const bool is_low = of_halves > measured * of_blocks;
    first.step(is_low);
    second.step(is_low);
    blocks.step(is_low);
  }
  return measured / (first.power() + second.power() - 1);
}

float finite_square(double value) { return static_cast<float>(std::min(value, 1e30)); }

}  // namespace

uint32_t next_decision(uint32_t samples) {
  uint32_t decision = first_decision;
  while (decision <= samples) decision += std::max(decision_step, std::bit_floor(decision) / 4);
  return decision;
}

template <class Real>
NoiseState unknown_noise(const Film<Real>& film) {
  const FilmView<Real> planes = film.view();
  const size_t pixels = static_cast<size_t>(film.window().pixels());
  uint64_t samples = 0, finished = 0;
  for (size_t i = 0; i < pixels; ++i) {
    samples += planes.samples[i];
    finished += planes.finished[i] ? 1 : 0;
  }
  NoiseState state;
  state.noise = 1;
  state.below = static_cast<double>(finished) / static_cast<double>(pixels);
  state.mean_samples = static_cast<double>(samples) / static_cast<double>(pixels);
  return state;
}

template NoiseState unknown_noise(const Film<float>&);
template NoiseState unknown_noise(const Film<double>&);

template <class Real>
void keep_variances(const Film<Real>& film) {
  const FilmView<Real> view = film.view();
  for (size_t i = 0; i < static_cast<size_t>(film.window().pixels()); ++i) {
    const PixelMean mean = pixel_mean(view, i);
    view.earlier_variance[i] = static_cast<Real>(mean.by_blocks);
    view.earlier_half_variance[i] = static_cast<Real>(mean.by_halves);
  }
}

template void keep_variances(const Film<float>&);
template void keep_variances(const Film<double>&);

template <class Real>
NoiseEstimate<Real>::NoiseEstimate(const RenderSettings& settings, const Film<Real>& film)
    : film_(film),
      target_(settings.asked.noise),
      most_samples_(settings.samples_per_pixel),
      width_(film.window().width()),
      height_(film.window().height()) {
  measure_pixels(settings);
  join_neighbours();
  if (settings.has_alpha) measure_alpha();
}

template <class Real>
void NoiseEstimate<Real>::measure_pixels(const RenderSettings& settings) {
  const FilmView<Real> film = film_.view();
  const size_t pixels = static_cast<size_t>(film_.window().pixels());
  errors_.resize(pixels);
  of_halves_.resize(pixels);
  const double darkest = settings.noise_curve ? 0 : darkest_luminance(film, pixels);
  std::optional<DisplayCurve> curve = settings.noise_curve;
  if (curve && settings.noise_exposure != ExposureRule::given)
    curve->scale = portable_exp2(exposure_of(film, width_, height_, settings.noise_exposure, settings.has_alpha));
  for (size_t i = 0; i < pixels; ++i) {
    const PixelMean mean = pixel_mean(film, i);
    if (!mean.is_known || !std::isfinite(mean.by_blocks) || !std::isfinite(mean.luminance))
      errors_[i] = of_halves_[i] = 1;
    if (!(mean.by_blocks > 0) || errors_[i] > 0) continue;
    double error = 0;
    if (curve) {
      error = curve->error(mean.luminance, std::sqrt(mean.by_blocks));
      error *= error;
    } else {
      const double reference = std::max(mean.luminance, darkest);
      error = mean.by_blocks / (reference * reference);
    }
    errors_[i] = finite_square(error);
    const double of_halves = error * (mean.by_halves / mean.by_blocks);
    of_halves_[i] = of_halves < 1e30 ? static_cast<float>(of_halves) : errors_[i];
  }
}

/// Colours alone would finish the edges of what is dark before their alpha is known. Its variance is at most that of
/// independent samples that are either covered or not.
template <class Real>
void NoiseEstimate<Real>::measure_alpha() {
  const FilmView<Real> film = film_.view();
  for (size_t i = 0; i < errors_.size(); ++i) {
    if (film.samples[i] == 0) continue;
    const float alpha = std::clamp(static_cast<float>(film.coverage(i)), 0.0f, 1.0f);
    const float error = alpha * (1 - alpha) / static_cast<float>(film.samples[i]);
    errors_[i] = std::max(errors_[i], error);
  }
}

template <class Real>
void NoiseEstimate<Real>::join_neighbours() {
  const FilmView<Real> film = film_.view();
  const auto tiles = [&](const auto& value) { return TileSums(errors_.size(), width_, height_, value); };
  const auto of_halves = [&](const auto& value) {
    return tiles([&](size_t i) {
      const uint32_t samples = estimated_samples(film, i);
      return samples > samples_per_block ? value(Halves(samples), samples) : 2.0;
    });
  };
  const TileSums by_blocks = tiles([&](size_t i) { return static_cast<double>(errors_[i]); });
  const TileSums by_halves = tiles([&](size_t i) { return static_cast<double>(of_halves_[i]); });
  const TileSums squares_by_blocks = tiles([&](size_t i) { return sqr(static_cast<double>(errors_[i])); });
  const TileSums counts = tiles([](size_t) { return 1.0; });
  const TileSums blocks = of_halves([](const Halves& halves, double) { return static_cast<double>(halves.blocks); });
  const TileSums of_first = of_halves([](const Halves& halves, double n) { return n / halves.first; });
  const TileSums of_second = of_halves([](const Halves& halves, double n) { return n / halves.second; });
  const std::vector<float> around = window_means(errors_, width_, height_, window_radius);
  double squares = 0;
  for (int row = 0; row < counts.rows(); ++row)
    for (int column = 0; column < counts.columns(); ++column) {
      const double sum = by_blocks.around(column, row), pixels = counts.around(column, row);
      const double agreeing = sum > 0 ? agreeing_pixels * squares_by_blocks.around(column, row) / sum : 0;
      const double halves = by_halves.around(column, row) + agreeing;
      const double measured = sum > 0 ? std::clamp(halves / (sum + agreeing), min_gain, 1.0) : 1;
      const double gain =
          variance_ratio(measured, {blocks.around(column, row) / pixels, of_first.around(column, row) / pixels,
                                    of_second.around(column, row) / pixels});
      const float wide = static_cast<float>(sum / pixels);
      for (int y = row * tile_size; y < std::min(height_, (row + 1) * tile_size); ++y)
        for (int x = column * tile_size; x < std::min(width_, (column + 1) * tile_size); ++x) {
          const size_t i = static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
          squares += gain * static_cast<double>(errors_[i]);
          errors_[i] = static_cast<float>(gain) * std::max(around[i], wide);
        }
    }
  mean_square_ = squares / static_cast<double>(errors_.size());
}

template <class Real>
void NoiseEstimate<Real>::finish_pixels() const {
  const FilmView<Real> film = film_.view();
  const float limit = static_cast<float>(target_ * target_);
  for (size_t i = 0; i < errors_.size(); ++i)
    if (errors_[i] < limit) film.finished[i] = 1;
}

template <class Real>
NoiseState NoiseEstimate<Real>::state() const {
  const FilmView<Real> film = film_.view();
  const float limit = static_cast<float>(target_ * target_);
  NoiseState state;
  state.noise = std::sqrt(mean_square_);
  uint64_t below = 0, samples = 0;
  for (size_t i = 0; i < errors_.size(); ++i) {
    const double n = film.samples[i];
    samples += film.samples[i];
    below += errors_[i] < limit || film.finished[i] ? 1 : 0;
    // One that is not finished is decided on again at the next number of samples at the earliest.
    const double most = std::max(film.samples[i], most_samples_);
    const double least = std::min<double>(next_decision(film.samples[i]), most);
    state.expected_samples +=
        film.finished[i] ? n : std::clamp(n * static_cast<double>(errors_[i]) / (target_ * target_), least, most);
  }
  const double pixels = static_cast<double>(errors_.size());
  state.below = static_cast<double>(below) / pixels;
  state.mean_samples = static_cast<double>(samples) / pixels;
  return state;
}

template class NoiseEstimate<float>;
template class NoiseEstimate<double>;

}  // namespace alhazen::impl

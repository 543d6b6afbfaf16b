#include "render/denoising/tile.h"

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/film/film_view.h"

namespace alhazen::impl::denoising {

Region Region::grown(int margin, const Region& bounds) const {
  return {std::max(x0 - margin, bounds.x0), std::max(y0 - margin, bounds.y0), std::min(x1 + margin, bounds.x1),
          std::min(y1 + margin, bounds.y1)};
}

TilePlane::TilePlane(int width, int height)
    : width_(width),
      height_(height),
      stride_(static_cast<size_t>(width) + 2 * plane_padding),
      values_(stride_ * (static_cast<size_t>(height) + 2 * plane_padding)) {}

void TilePlane::pad() {
  for (int y = 0; y < height_; ++y) {
    float* const values = row(y);
    std::fill(values - plane_padding, values, values[0]);
    std::fill(values + width_, values + width_ + plane_padding, values[width_ - 1]);
  }
  const auto copy = [&](int to, int from) { std::copy_n(row(from) - plane_padding, stride_, row(to) - plane_padding); };
  for (int i = 1; i <= plane_padding; ++i) {
    copy(-i, 0);
    copy(height_ - 1 + i, height_ - 1);
  }
}

void blur(TilePlane& plane, int radius, int threads) {
  const int width = plane.width(), height = plane.height();
  TilePlane rows(width, height);
  const float norm = 1 / static_cast<float>((radius + 1) * (radius + 1));
  const auto weight = [&](int i) { return norm * static_cast<float>(radius + 1 - std::abs(i)); };
  plane.pad();
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int y = 0; y < height; ++y) {
    const float* const from = plane.row(y);
    float* const to = rows.row(y);
    for (int i = -radius; i <= radius; ++i)
      for (int x = 0; x < width; ++x) to[x] += weight(i) * from[x + i];
  }
  rows.pad();
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int y = 0; y < height; ++y) {
    float* const to = plane.row(y);
    std::fill_n(to, width, 0.0f);
    for (int i = -radius; i <= radius; ++i) {
      const float* const from = rows.row(y + i);
      for (int x = 0; x < width; ++x) to[x] += weight(i) * from[x];
    }
  }
  plane.pad();
}

namespace {

float luminance_at(const ColourTile& colour, int x, int y) {
  return 0.2126f * colour[0].row(y)[x] + 0.7152f * colour[1].row(y)[x] + 0.0722f * colour[2].row(y)[x];
}

/// A half of a pixel that is much brighter than its neighbours, while the other half is not, holds a rare sample of
/// much light, which would become a spot. It is darkened to what its brightest neighbours have. Both halves of a pixel
/// agree in the limit, so nothing is darkened there.
void remove_fireflies(Tile& tile, int threads) {
  const int width = tile.region.width(), height = tile.region.height();
  constexpr int radius = 2, rank = 3;
  constexpr float limit = 1.5f;
  std::array<TilePlane, 2> light{TilePlane(width, height), TilePlane(width, height)};
  for (size_t h = 0; h < 2; ++h) {
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) light[h].row(y)[x] = luminance_at(tile.half[h], x, y);
    light[h].pad();
  }
#pragma omp parallel for schedule(static) num_threads(threads)
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (size_t h = 0; h < 2; ++h) {
        const float own = light[h].row(y)[x], other = light[1 - h].row(y)[x];
        if (!(own > limit * other)) continue;
        std::array<float, (2 * radius + 1) * (2 * radius + 1)> around;
        auto end = around.begin();
        for (int dy = -radius; dy <= radius; ++dy)
          for (int dx = -radius; dx <= radius; ++dx)
            if (dx != 0 || dy != 0) *end++ = std::max(light[0].row(y + dy)[x + dx], light[1].row(y + dy)[x + dx]);
        std::nth_element(around.begin(), around.begin() + rank - 1, end, std::greater<>());
        const float most = limit * std::max(around[rank - 1], other);
        if (own <= most) continue;
        for (TilePlane& channel : tile.half[h]) channel.row(y)[x] *= most / own;
      }
}

void read_values(const NoisyImage& image, Tile& tile) {
  const Region& region = tile.region;
  for (int y = 0; y < region.height(); ++y)
    for (int x = 0; x < region.width(); ++x) {
      const size_t i =
          static_cast<size_t>(y + region.y0) * static_cast<size_t>(image.width) + static_cast<size_t>(x + region.x0);
      const uint32_t samples = image.samples[i], odd_samples = samples_in_odd_blocks(samples);
      const float fraction = image.odd_fraction[i];
      const bool has_halves = fraction > 0;
      for (size_t c = 0; c < 3; ++c) {
        const float mean = image.radiance.mean[3 * i + c], odd = image.radiance.odd[3 * i + c];
        tile.half[0][c].row(y)[x] = (mean - odd * fraction) / (1 - fraction);
        tile.half[1][c].row(y)[x] = has_halves ? odd : mean;
      }
      tile.odd_fraction.row(y)[x] = has_halves ? fraction : 0.5f;
      tile.inside.row(y)[x] = samples > 0 ? 1.0f : 0.0f;
      // Features are not weighted by the pixel filter.
      const float odd_fraction = has_halves ? static_cast<float>(odd_samples) / static_cast<float>(samples) : 0;
      const auto even_of = [&](float mean, float odd) { return (mean - odd * odd_fraction) / (1 - odd_fraction); };
      const auto put = [&](size_t f, float mean, float odd) {
        tile.features[f].row(y)[x] = mean;
        tile.noisy_features[0][f].row(y)[x] = even_of(mean, odd);
        tile.noisy_features[1][f].row(y)[x] = has_halves ? odd : mean;
        const float difference = has_halves ? even_of(mean, odd) - odd : 0;
        tile.feature_variance[f].row(y)[x] = difference * difference / 4;
      };
      for (size_t c = 0; c < 3; ++c) {
        // Where rays hit nothing the albedo is 1, so that what is divided by it varies little over silhouettes.
        const float missed = 1 - image.hits[i];
        put(c, image.albedo.mean[3 * i + c] + missed, image.albedo.odd[3 * i + c] + missed);
        put(3 + c, image.normal.mean[3 * i + c], image.normal.odd[3 * i + c]);
      }
      put(6, image.depth.mean[i], image.depth.odd[i]);
    }
}

/// The variance among the samples of a pixel has the right shape, and the squared difference of halves, which knows how
/// evenly samples are distributed, the right size (Rousselle, Manzi, Zwicker 2013, section 4).
void estimate_variance(const NoisyImage& image, Tile& tile, int threads) {
  const int width = tile.region.width(), height = tile.region.height();
  TilePlane of_samples(width, height), smooth(width, height), coverage = tile.inside;
  const auto index_of = [&](int x, int y) {
    return static_cast<size_t>(y + tile.region.y0) * static_cast<size_t>(image.width) +
           static_cast<size_t>(x + tile.region.x0);
  };
  const auto has_halves_at = [&](int x, int y) { return image.odd_fraction[index_of(x, y)] > 0; };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const size_t i = index_of(x, y);
      const float of_mean = image.variance[i] / static_cast<float>(std::max(1u, image.samples[i]));
      of_samples.row(y)[x] = smooth.row(y)[x] = of_mean;
      const bool has_halves = has_halves_at(x, y);
      for (size_t c = 0; c < 3; ++c) {
        // With halves a and b of fractions f and 1 - f, a - b has the variance s / f + s / (1 - f) if s is that of the
        // mean.
        const float difference = tile.half[0][c].row(y)[x] - tile.half[1][c].row(y)[x], odd = image.odd_fraction[i];
        tile.variance[0][c].row(y)[x] = has_halves ? difference * difference * odd * (1 - odd) : of_mean;
      }
    }
  constexpr int radius = 5;
  blur(smooth, radius, threads);
  // Pixels without samples have no variance, and do not count.
  blur(coverage, radius, threads);
  for (size_t c = 0; c < 3; ++c) {
    TilePlane& even = tile.variance[0][c];
    TilePlane& odd = tile.variance[1][c];
    blur(even, radius, threads);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const float covered = std::max(coverage.row(y)[x], 1e-6f), around = smooth.row(y)[x] / covered;
        const bool is_known = around > 0 && tile.inside.row(y)[x] > 0;
        const float shape = is_known ? std::min(of_samples.row(y)[x] / around, 8.0f) : 1.0f;
        const float of_mean = even.row(y)[x] / covered * (0.25f + 0.75f * shape);
        const bool has_halves = has_halves_at(x, y);
        const float fraction = tile.odd_fraction.row(y)[x];
        even.row(y)[x] = has_halves ? of_mean / (1 - fraction) : of_mean;
        odd.row(y)[x] = has_halves ? of_mean / fraction : of_mean;
      }
  }
}

constexpr int band_height = 16;

/// Rows of a band, with a pixel more on each side, that a thread works on.
struct BandMemory {
  size_t stride;
  std::vector<float> distances, weights, squares;
  std::array<std::vector<float>, 3> sums;

  explicit BandMemory(int width) : stride(static_cast<size_t>(width) + 2), distances(stride * (band_height + 2)) {
    for (std::vector<float>* values : {&weights, &squares, &sums[0], &sums[1], &sums[2]})
      values->resize(stride * band_height);
  }
};

/// Filters the rows from `y0` on of a few features by their similarity, with weights from all of them.
void filter_band(const Tile& tile, size_t first, size_t last, int y0, int y1, BandMemory& m,
                 std::array<TilePlane, feature_count>& filtered, std::array<TilePlane, feature_count>& variance) {
  const int width = tile.region.width();
  constexpr int radius = 3;
  for (std::vector<float>* values : {&m.weights, &m.squares, &m.sums[0], &m.sums[1], &m.sums[2]})
    std::fill(values->begin(), values->end(), 0.0f);
  for (int dy = -radius; dy <= radius; ++dy)
    for (int dx = -radius; dx <= radius; ++dx) {
      for (int y = y0 - 1; y <= y1; ++y) {
        float* const to = m.distances.data() + static_cast<size_t>(y - y0 + 1) * m.stride;
        std::fill_n(to, m.stride, 0.0f);
        for (size_t f = first; f < last; ++f) {
          const float *const a = tile.features[f].row(y) - 1, *const b = tile.features[f].row(y + dy) + dx - 1;
          const float *const va = tile.feature_variance[f].row(y) - 1, *const vb =
                                                                           tile.feature_variance[f].row(y + dy) + dx -
                                                                           1;
          for (size_t x = 0; x < m.stride; ++x) {
            const float difference = a[x] - b[x];
            to[x] += (difference * difference - (va[x] + std::min(va[x], vb[x]))) /
                     (va[x] + vb[x] + 1e-4f * (a[x] * a[x] + 1e-4f));
          }
        }
      }
      for (int y = y0; y < y1; ++y) {
        const size_t row = static_cast<size_t>(y - y0) * m.stride;
        const float *const above = m.distances.data() + row, *const here = above + m.stride,
                           *const below = here + m.stride;
        const float* const inside = tile.inside.row(y + dy) + dx;
        for (size_t x = 0; x < static_cast<size_t>(width); ++x) {
          const float corners = (above[x] + above[x + 2]) + (below[x] + below[x + 2]);
          const float sides = (above[x + 1] + below[x + 1]) + (here[x] + here[x + 2]);
          const float distance = std::max(0.0f, (corners + 2 * sides + 4 * here[x + 1]) / 16);
          const float near = std::max(0.0f, 1 - distance / 4), squared = near * near;
          const float weight = inside[x] * squared * squared;
          m.weights[row + x] += weight;
          m.squares[row + x] += weight * weight;
          for (size_t f = first; f < last; ++f)
            m.sums[f - first][row + x] += weight * tile.features[f].row(y + dy)[static_cast<int>(x) + dx];
        }
      }
    }
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < width; ++x) {
      const size_t i = static_cast<size_t>(y - y0) * m.stride + static_cast<size_t>(x);
      for (size_t f = first; f < last; ++f) {
        const bool has_any = m.weights[i] > 0;
        filtered[f].row(y)[x] = has_any ? m.sums[f - first][i] / m.weights[i] : tile.features[f].row(y)[x];
        variance[f].row(y)[x] =
            tile.feature_variance[f].row(y)[x] * (has_any ? m.squares[i] / (m.weights[i] * m.weights[i]) : 1.0f);
      }
    }
}

/// Features are noisy where lenses, motion or edges blur them. Non-local means average what differs by noise alone
/// (Rousselle, Manzi, Zwicker 2013, section 5.1).
void filter_features(Tile& tile, int threads) {
  const int width = tile.region.width(), height = tile.region.height();
  std::array<TilePlane, feature_count> filtered, variance;
  for (auto* planes : {&filtered, &variance})
    for (TilePlane& plane : *planes) plane = TilePlane(width, height);
  std::vector<BandMemory> memory(static_cast<size_t>(threads), BandMemory(width));
#pragma omp parallel for schedule(dynamic) num_threads(threads)
  for (int y = 0; y < height; y += band_height) {
    BandMemory& m = memory[static_cast<size_t>(omp_get_thread_num())];
    const int end = std::min(y + band_height, height);
    filter_band(tile, 0, 3, y, end, m, filtered, variance);
    filter_band(tile, 3, 6, y, end, m, filtered, variance);
    filter_band(tile, 6, 7, y, end, m, filtered, variance);
  }
  tile.features = std::move(filtered);
  tile.feature_variance = std::move(variance);
  for (auto* planes : {&tile.features, &tile.feature_variance})
    for (TilePlane& plane : *planes) plane.pad();
}

void divide_by_albedo(Tile& tile) {
  constexpr float least = 0.02f;
  for (size_t c = 0; c < 3; ++c)
    for (int y = 0; y < tile.region.height(); ++y)
      for (int x = 0; x < tile.region.width(); ++x) {
        const float divisor = std::max(tile.features[c].row(y)[x], least);
        tile.divisor[c].row(y)[x] = divisor;
        for (ColourTile& half : tile.half) half[c].row(y)[x] /= divisor;
        for (ColourTile& variance : tile.variance) variance[c].row(y)[x] /= divisor * divisor;
      }
}

}  // namespace

Tile read_tile(const NoisyImage& image, const Region& region, int threads) {
  const int width = region.width(), height = region.height();
  Tile tile;
  tile.region = region;
  for (ColourTile* colours : {&tile.divisor, &tile.half[0], &tile.half[1], &tile.variance[0], &tile.variance[1]})
    for (TilePlane& plane : *colours) plane = TilePlane(width, height);
  for (auto* planes : {&tile.features, &tile.feature_variance, &tile.noisy_features[0], &tile.noisy_features[1]})
    for (TilePlane& plane : *planes) plane = TilePlane(width, height);
  tile.odd_fraction = tile.inside = TilePlane(width, height);
  read_values(image, tile);
  remove_fireflies(tile, threads);
  estimate_variance(image, tile, threads);
  for (TilePlane& plane : tile.feature_variance) blur(plane, 1, threads);
  for (auto* planes : {&tile.features, &tile.noisy_features[0], &tile.noisy_features[1]})
    for (TilePlane& plane : *planes) plane.pad();
  filter_features(tile, threads);
  divide_by_albedo(tile);
  for (ColourTile* colours : {&tile.half[0], &tile.half[1], &tile.variance[0], &tile.variance[1]})
    for (TilePlane& plane : *colours) plane.pad();
  return tile;
}

}  // namespace alhazen::impl::denoising

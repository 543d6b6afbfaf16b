// The denoiser `builtin`, which runs on any machine: first-order regression on features, with weights by colours.
//
// Each pixel has two halves of its samples (core/film/film_view.h). Around each pixel of a lattice, a window of the
// colours of one half is fitted by a linear function of albedo, normal, depth and position, with weights by how similar
// the patches of the other half are (non-local means). So the weights do not depend on the noise that they are to
// average. The fits of all windows that contain a pixel are averaged. (Bitterli et al. 2016, "Nonlinearly Weighted
// First-order Regression for Denoising Monte Carlo Renderings"; Rousselle, Manzi, Zwicker 2013, "Robust Denoising using
// Feature and Color Information"; Moon, Carr, Yoon 2014, "Adaptive Rendering Based on Weighted Local Regression".)

#include <omp.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

#include "render/denoiser.h"
#include "render/denoising/builtin.h"
#include "render/denoising/kernels.h"
#include "render/denoising/read_window.h"
#include "render/denoising/tile.h"

namespace alhazen::impl::denoising {

namespace {

/// The fits are made twice: with a small neighbourhood of pixels that are much alike, and with a large one.
struct Candidate {
  float colour;   ///< the bandwidth of the distance between patches
  float spatial;  ///< of the distance in pixels; 0: none
};
constexpr Candidate candidates[] = {{0.5f, 3}, {1, 0}};
constexpr size_t candidate_count = std::size(candidates);
/// The bandwidth of the distance between features.
constexpr float feature_bandwidth = 1;
/// Windows are fitted around every second pixel of every second row, and around those whose weights from these windows
/// sum to less than `enough_weight`.
constexpr int stride = 2;
constexpr float enough_weight = 2;
/// Errors of candidates are averaged this far, and then the choice between them.
constexpr int error_radius = 6, choice_radius = 3;

constexpr int max_threads = 64;
/// So far outside of a tile are windows that contribute to it, and pixels that contribute to these.
constexpr int anchor_margin = window_radius + error_radius + choice_radius,
              tile_margin = anchor_margin + window_radius + patch_radius + 8;

constexpr int max_anchors = cell_size * cell_size / (stride * stride);

/// What the fits of one half predict for each pixel, summed with weights.
struct Estimate {
  ColourTile sum;
  TilePlane weight;

  Estimate(int width, int height) : weight(width, height) {
    for (TilePlane& plane : sum) plane = TilePlane(width, height);
  }
};

/// By candidate and half: candidate * 2 + half.
using Estimates = std::vector<Estimate>;

/// Pixels around which a window is fitted, from the corner of their cell.
struct Anchors {
  int count = 0;
  int x[max_anchors], y[max_anchors];

  void add(int column, int row) {
    x[count] = column;
    y[count] = row;
    ++count;
  }
};

/// What a thread needs.
struct CellMemory {
  Anchors anchors;
  std::vector<WindowRow> distances[2] = {std::vector<WindowRow>(max_anchors), std::vector<WindowRow>(max_anchors)};
  WindowInputs inputs;
  WindowColours colours[2];
  WindowRow features, weights, inside, variance;
  WindowRow predicted[3];
};

void add_prediction(const CellMemory& m, int x, int y, Estimate& to) {
  const float* weights = m.weights.values;
  const float* predicted[3] = {m.predicted[0].values, m.predicted[1].values, m.predicted[2].values};
  for (int dy = -window_radius; dy <= window_radius; ++dy) {
    float* const weight = to.weight.row(y + dy) + x - window_radius;
    for (int i = 0; i < window_side; ++i) weight[i] += weights[i];
    for (size_t c = 0; c < 3; ++c) {
      float* const sum = to.sum[c].row(y + dy) + x - window_radius;
      for (int i = 0; i < window_side; ++i) sum[i] += weights[i] * predicted[c][i];
      predicted[c] += window_side;
    }
    weights += window_side;
  }
}

void find_distances(const Kernels& kernels, const Tile& tile, const Region& cell, CellMemory& m) {
  for (size_t half = 0; half < 2; ++half) {
    PatchRequest request{};
    for (size_t c = 0; c < 3; ++c) {
      request.values[c] = tile.half[half][c].row(cell.y0 - patch_radius) + cell.x0 - patch_radius;
      request.variances[c] = tile.variance[half][c].row(cell.y0 - patch_radius) + cell.x0 - patch_radius;
    }
    request.stride = tile.half[0][0].stride();
    request.width = cell.width();
    request.height = cell.height();
    request.anchors = m.anchors.count;
    request.x = m.anchors.x;
    request.y = m.anchors.y;
    request.distances = m.distances[half].data();
    kernels.patch_distances(request);
  }
}

void find_weights(const WindowRow& patches, const WindowRow& features, const WindowRow& inside,
                  const Candidate& candidate, WindowRow& weights) {
  const float patch_scale = 1 / (8 * candidate.colour * candidate.colour),
              feature_scale = 1 / (8 * feature_bandwidth * feature_bandwidth),
              spatial_scale = candidate.spatial > 0 ? 1 / (16 * candidate.spatial * candidate.spatial) : 0;
  int i = 0;
  for (int dy = -window_radius; dy <= window_radius; ++dy)
    for (int dx = -window_radius; dx <= window_radius; ++dx, ++i) {
      const float distance = patches.values[i] * patch_scale + features.values[i] * feature_scale +
                             static_cast<float>(dx * dx + dy * dy) * spatial_scale;
      // (1 - d / 8)^8 is close to exp(-d), and ends.
      const float near = std::max(0.0f, 1 - distance), squared = near * near, fourth = squared * squared;
      weights.values[i] = fourth * fourth * inside.values[i];
    }
  std::fill(weights.values + window_size, weights.values + padded_window, 0.0f);
}

/// Fits the windows around the anchors of a cell and adds what they predict.
void fit_cell(const Kernels& kernels, const Tile& tile, const Region& cell, CellMemory& m, Estimates& estimates) {
  find_distances(kernels, tile, cell, m);
  for (int a = 0; a < m.anchors.count; ++a) {
    const int x = cell.x0 + m.anchors.x[a], y = cell.y0 + m.anchors.y[a];
    read_inputs(tile, x, y, m.inputs, m.features);
    read_window(tile.inside, x, y, m.inside);
    for (WindowColours& colours : m.colours) std::fill_n(colours.variance.values, padded_window, 0.0f);
    for (size_t c = 0; c < 3; ++c) {
      for (size_t half = 0; half < 2; ++half) {
        read_window(tile.variance[half][c], x, y, m.variance);
        read_window(tile.half[half][c], x, y, m.colours[half].channels[c]);
        for (int i = 0; i < padded_window; ++i) m.colours[half].variance.values[i] += m.variance.values[i];
      }
    }
    for (size_t half = 0; half < 2; ++half) {
      const WindowRow& distances = m.distances[1 - half][static_cast<size_t>(a)];
      for (size_t candidate = 0; candidate < candidate_count; ++candidate) {
        find_weights(distances, m.features, m.inside, candidates[candidate], m.weights);
        kernels.fit_window(m.inputs, static_cast<int>(half), m.colours[half], m.weights, m.predicted);
        add_prediction(m, x, y, estimates[candidate * 2 + half]);
      }
    }
  }
}

/// Calls `work(cell, memory of the thread)` for each cell of `wanted`. Cells that are worked on at a time are so far
/// from each other that what they write does not overlap, and the order of the sums of a pixel is always the same.
template <class Work>
void for_each_cell(const Region& wanted, std::vector<CellMemory>& memory, const Work& work) {
  const int columns = (wanted.width() + cell_size - 1) / cell_size,
            rows = (wanted.height() + cell_size - 1) / cell_size;
  std::vector<Region> cells;
  for (int first_row = 0; first_row < 2; ++first_row)
    for (int first_column = 0; first_column < 2; ++first_column) {
      cells.clear();
      for (int row = first_row; row < rows; row += 2)
        for (int column = first_column; column < columns; column += 2) {
          const int x = wanted.x0 + column * cell_size, y = wanted.y0 + row * cell_size;
          cells.push_back({x, y, std::min(x + cell_size, wanted.x1), std::min(y + cell_size, wanted.y1)});
        }
#pragma omp parallel for schedule(dynamic) num_threads(static_cast <int>(memory.size()))
      for (size_t i = 0; i < cells.size(); ++i) work(cells[i], memory[static_cast<size_t>(omp_get_thread_num())]);
    }
}

/// Fits the windows around those pixels of a cell that `is_anchor(x, y)` selects.
template <class Select>
void fit_selected(const Kernels& kernels, const Tile& tile, const Region& cell, const Select& is_anchor, CellMemory& m,
                  Estimates& estimates) {
  m.anchors.count = 0;
  const auto fit = [&] {
    if (m.anchors.count > 0) fit_cell(kernels, tile, cell, m, estimates);
    m.anchors.count = 0;
  };
  for (int y = cell.y0; y < cell.y1; ++y)
    for (int x = cell.x0; x < cell.x1; ++x) {
      if (!is_anchor(x, y)) continue;
      m.anchors.add(x - cell.x0, y - cell.y0);
      if (m.anchors.count == max_anchors) fit();
    }
  fit();
}

void fit_tile(const Kernels& kernels, const Tile& tile, const Region& wanted, int threads, Estimates& estimates) {
  static_assert(cell_size >= 2 * window_radius + 1);
  std::vector<CellMemory> memory(static_cast<size_t>(threads));
  for_each_cell(wanted, memory, [&](const Region& cell, CellMemory& m) {
    const auto is_on_lattice = [&](int x, int y) {
      return (x + tile.region.x0) % stride == 0 && (y + tile.region.y0) % stride == 0;
    };
    fit_selected(kernels, tile, cell, is_on_lattice, m, estimates);
  });
  TilePlane least(tile.region.width(), tile.region.height());
  for (int y = wanted.y0; y < wanted.y1; ++y)
    for (int x = wanted.x0; x < wanted.x1; ++x) {
      float weight = estimates[0].weight.row(y)[x];
      for (const Estimate& estimate : estimates) weight = std::min(weight, estimate.weight.row(y)[x]);
      least.row(y)[x] = weight;
    }
  for_each_cell(wanted, memory, [&](const Region& cell, CellMemory& m) {
    const auto is_unlike_others = [&](int x, int y) { return least.row(y)[x] < enough_weight; };
    fit_selected(kernels, tile, cell, is_unlike_others, m, estimates);
  });
}

/// The mean of both halves' estimates of one candidate, weighted by their parts of the samples, and its estimated
/// squared error, relative to brightness and noise. A half's estimate is compared with the other half of the samples,
/// which it does not depend on.
void assess(const Tile& tile, const Estimate* of_halves, ColourTile& result, TilePlane& error) {
  const int width = tile.region.width(), height = tile.region.height();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float sum = 0, scale = 1e-10f;
      const float odd_fraction = tile.odd_fraction.row(y)[x], even_fraction = 1 - odd_fraction;
      for (size_t c = 0; c < 3; ++c) {
        float estimate[2];
        for (size_t half = 0; half < 2; ++half) {
          const float weight = of_halves[half].weight.row(y)[x];
          estimate[half] = weight > 0 ? of_halves[half].sum[c].row(y)[x] / weight : tile.half[half][c].row(y)[x];
        }
        const float even_variance = tile.variance[0][c].row(y)[x], odd_variance = tile.variance[1][c].row(y)[x];
        const float a = estimate[0] - tile.half[1][c].row(y)[x], b = estimate[1] - tile.half[0][c].row(y)[x];
        const float between = estimate[0] - estimate[1],
                    mean = even_fraction * estimate[0] + odd_fraction * estimate[1];
        sum += even_fraction * (a * a - odd_variance) + odd_fraction * (b * b - even_variance) -
               even_fraction * odd_fraction * between * between;
        scale += 0.5f * (even_variance + odd_variance) + 0.01f * mean * mean;
        result[c].row(y)[x] = std::max(0.0f, mean);
      }
      error.row(y)[x] = sum / scale * tile.inside.row(y)[x];
    }
}

void denoise_tile(const Kernels& kernels, const NoisyImage& image, const Region& core, int threads,
                  std::vector<float>& denoised) {
  const Region bounds{0, 0, image.width, image.height};
  const Region region = core.grown(tile_margin, bounds), wanted = core.grown(anchor_margin, bounds);
  const Tile tile = read_tile(image, region, threads);
  const int width = region.width(), height = region.height();
  Estimates estimates;
  for (size_t i = 0; i < 2 * candidate_count; ++i) estimates.emplace_back(width, height);
  fit_tile(kernels, tile, {wanted.x0 - region.x0, wanted.y0 - region.y0, wanted.x1 - region.x0, wanted.y1 - region.y0},
           threads, estimates);
  std::array<ColourTile, candidate_count> results;
  std::array<TilePlane, candidate_count> errors;
  for (size_t i = 0; i < candidate_count; ++i) {
    for (TilePlane& plane : results[i]) plane = TilePlane(width, height);
    errors[i] = TilePlane(width, height);
    assess(tile, &estimates[2 * i], results[i], errors[i]);
    blur(errors[i], error_radius, threads);
  }
  static_assert(candidate_count == 2);
  TilePlane choice(width, height);  // the weight of the second candidate
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) choice.row(y)[x] = errors[1].row(y)[x] < errors[0].row(y)[x] ? 1.0f : 0.0f;
  blur(choice, choice_radius, threads);
  for (int y = core.y0; y < core.y1; ++y)
    for (int x = core.x0; x < core.x1; ++x) {
      const int row = y - region.y0, column = x - region.x0;
      const float t = choice.row(row)[column];
      const size_t pixel = static_cast<size_t>(y) * static_cast<size_t>(image.width) + static_cast<size_t>(x);
      for (size_t c = 0; c < 3; ++c) {
        const float first = results[0][c].row(row)[column], second = results[1][c].row(row)[column];
        denoised[3 * pixel + c] = (first + t * (second - first)) * tile.divisor[c].row(row)[column];
      }
    }
}

class BuiltinDenoiser final : public Denoiser {
 public:
  std::string name() const override { return "builtin"; }
  std::string details() const override { return "regression on albedo, normal and depth, on any CPU"; }
  std::string problem() const override { return {}; }
  std::vector<float> denoise(const NoisyImage& image, const DenoiseOptions& options) const override {
    return denoise_in_tiles(image, default_tile_size, select_kernels(), std::clamp(options.threads, 1, max_threads));
  }
};

}  // namespace

std::vector<float> denoise_in_tiles(const NoisyImage& image, int tile_size, const Kernels& kernels, int threads) {
  std::vector<float> denoised(3 * image.pixels());
  for (int y = 0; y < image.height; y += tile_size)
    for (int x = 0; x < image.width; x += tile_size)
      denoise_tile(kernels, image, {x, y, std::min(x + tile_size, image.width), std::min(y + tile_size, image.height)},
                   threads, denoised);
  return denoised;
}

}  // namespace alhazen::impl::denoising

namespace alhazen::impl {

std::unique_ptr<Denoiser> make_builtin_denoiser() { return std::make_unique<denoising::BuiltinDenoiser>(); }

}  // namespace alhazen::impl

// The costly loops of the built-in denoiser, compiled once per instruction set.

#include <cmath>
#include <cstddef>

#include "core/math/scalar.h"
#include "core/simd/lanes.h"
#include "render/denoising/kernels.h"

namespace ALHAZEN_CORE {

namespace {

using denoising::lanes;
using denoising::max_unknowns;
using denoising::padded_window;
using denoising::WindowRow;
using Pack = Lanes<float, lanes>;

constexpr int window_radius = denoising::window_radius, patch_radius = denoising::patch_radius,
              window_size = denoising::window_size;

ALHAZEN_INLINE float sum_of(const Pack& pack) {
  float a[lanes];
  pack.store(a);
  return ((a[0] + a[4]) + (a[2] + a[6])) + ((a[1] + a[5]) + (a[3] + a[7]));
}

/// Writes the sums of a * b[k] for `count` rows b.
template <int count>
ALHAZEN_INLINE void dot(const float* a, const float* const* b, float* to) {
  Pack sums[count];
  for (int k = 0; k < count; ++k) sums[k] = Pack::all(0);
  for (int i = 0; i < padded_window; i += lanes) {
    const Pack x = Pack::load(a + i);
    for (int k = 0; k < count; ++k) sums[k] = sums[k] + x * Pack::load(b[k] + i);
  }
  for (int k = 0; k < count; ++k) to[k] = sum_of(sums[k]);
}

ALHAZEN_INLINE void multiply(const float* a, const float* b, float* to) {
  for (int i = 0; i < padded_window; i += lanes) (Pack::load(a + i) * Pack::load(b + i)).store(to + i);
}

struct System {
  int count;
  float matrix[max_unknowns][max_unknowns];  ///< its upper triangle is given; the lower one becomes the factor
  float right[3][max_unknowns];              ///< becomes the solutions
};

/// Solves the symmetric, positive definite system by Cholesky's method.
void solve(System& s) {
  const int n = s.count;
  float inverse[max_unknowns];
  for (int j = 0; j < n; ++j) {
    float diagonal = s.matrix[j][j];
    const float least = diagonal * 1e-6f + 1e-20f;
    for (int k = 0; k < j; ++k) diagonal -= s.matrix[j][k] * s.matrix[j][k];
    inverse[j] = 1 / std::sqrt(max(diagonal, least));
    for (int i = j + 1; i < n; ++i) {
      float value = s.matrix[j][i];
      for (int k = 0; k < j; ++k) value -= s.matrix[i][k] * s.matrix[j][k];
      s.matrix[i][j] = value * inverse[j];
    }
  }
  for (auto& b : s.right) {
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < i; ++k) b[i] -= s.matrix[i][k] * b[k];
      b[i] *= inverse[i];
    }
    for (int i = n - 1; i >= 0; --i) {
      for (int k = i + 1; k < n; ++k) b[i] -= s.matrix[k][i] * b[k];
      b[i] *= inverse[i];
    }
  }
}

}  // namespace

void fit_window(const denoising::WindowInputs& inputs, int half, const denoising::WindowColours& colours,
                const WindowRow& weights, WindowRow* predicted) {
  const int n = inputs.count, rows = n + 4;
  const float* row[max_unknowns + 4];
  for (int j = 0; j < n; ++j) row[j] = j == 0 || j >= n - 2 ? inputs.rows[j].values : inputs.noisy[half][j - 1].values;
  for (int c = 0; c < 3; ++c) row[n + c] = colours.channels[c].values;
  row[n + 3] = colours.variance.values;
  System s;
  s.count = n;
  WindowRow weighted;
  float variance = 0;
  for (int j = 0; j < n; ++j) {
    const float* first = weights.values;
    if (j > 0) {
      multiply(first, row[j], weighted.values);
      first = weighted.values;
    }
    float sums[max_unknowns + 8];
    int k = j;
    for (; k + 4 <= rows; k += 4) dot<4>(first, row + k, sums + k);
    for (; k + 2 <= rows; k += 2) dot<2>(first, row + k, sums + k);
    if (k < rows) dot<1>(first, row + k, sums + k);
    for (k = j; k < n; ++k) s.matrix[j][k] = sums[k];
    for (int c = 0; c < 3; ++c) s.right[c][j] = sums[n + c];
    if (j == 0) variance = sums[n + 3];
  }
  // What colours vary by beyond their noise is about what slopes have to explain. So it is the prior variance of a
  // slope over a unit of its input, which makes this a ridge regression.
  const float total = max(s.matrix[0][0], 1e-20f);
  float spread = 0;
  for (int c = 0; c < 3; ++c) {
    float squares;
    multiply(weights.values, row[n + c], weighted.values);
    dot<1>(weighted.values, row + n + c, &squares);
    const float mean = s.right[c][0] / total;
    spread += max(0.0f, squares / total - mean * mean);
  }
  variance /= total;
  const float signal = max(spread - variance, 0.01f * variance + 1e-12f);
  const float ridge = min(100.0f, static_cast<float>(n - 1) * variance / (signal * total));
  s.matrix[0][0] = total;
  for (int j = 1; j < n; ++j)
    s.matrix[j][j] += ridge * (s.matrix[j][j] + inputs.floor[j] * total) + 1e-3f * inputs.floor[j] * total;
  solve(s);
  for (int i = 0; i < padded_window; i += lanes) {
    Pack sums[3];
    for (int c = 0; c < 3; ++c) sums[c] = Pack::all(s.right[c][0]);
    for (int j = 1; j < n; ++j) {
      const Pack input = Pack::load(inputs.rows[j].values + i);
      for (int c = 0; c < 3; ++c) sums[c] = sums[c] + Pack::all(s.right[c][j]) * input;
    }
    for (int c = 0; c < 3; ++c) sums[c].store(predicted[c].values + i);
  }
}

void patch_distances(const denoising::PatchRequest& r) {
  constexpr int side = denoising::cell_side, padded = (side + lanes - 1) / lanes * lanes;
  alignas(64) float pixel[side][padded + lanes], sums[side][padded];
  const int width = r.width + 2 * patch_radius, height = r.height + 2 * patch_radius;
  constexpr float norm = 1.0f / ((2 * patch_radius + 1) * (2 * patch_radius + 1));
  int offset = 0;
  for (int dy = -window_radius; dy <= window_radius; ++dy)
    for (int dx = -window_radius; dx <= window_radius; ++dx, ++offset) {
      for (int y = 0; y < height; ++y) {
        const size_t here = static_cast<size_t>(y) * r.stride;
        const float* values[3];
        const float* variances[3];
        for (int c = 0; c < 3; ++c) {
          values[c] = r.values[c] + here;
          variances[c] = r.variances[c] + here;
        }
        const std::ptrdiff_t there = dy * static_cast<std::ptrdiff_t>(r.stride) + dx;
        for (int x = 0; x < width; x += lanes) {
          Pack above = Pack::all(0), below = Pack::all(1e-10f);
          for (int c = 0; c < 3; ++c) {
            const Pack u = Pack::load(values[c] + x), other_u = Pack::load(values[c] + there + x),
                       v = Pack::load(variances[c] + x), other_v = Pack::load(variances[c] + there + x),
                       difference = u - other_u;
            above = above + (difference * difference - (v + min(v, other_v)));
            below = below + ((v + other_v) + Pack::all(1e-5f) * (u * u + other_u * other_u));
          }
          (above / below).store(&pixel[y][x]);
        }
      }
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < r.width; x += lanes) {
          const float* const p = &pixel[y][x];
          const auto at = [&](int i) { return Pack::load(p + i); };
          (((at(0) + at(6)) + (at(1) + at(5))) + ((at(2) + at(4)) + at(3))).store(&sums[y][x]);
        }
      for (int a = 0; a < r.anchors; ++a) {
        float sum = 0;
        for (int i = 0; i <= 2 * patch_radius; ++i) sum += sums[r.y[a] + i][r.x[a]];
        r.distances[a].values[offset] = max(0.0f, sum * norm);
      }
    }
}

denoising::Kernels denoising_kernels() { return {fit_window, patch_distances}; }

}  // namespace ALHAZEN_CORE

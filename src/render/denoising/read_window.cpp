#include "render/denoising/read_window.h"

#include <algorithm>
#include <cmath>

namespace alhazen::impl::denoising {

void read_window(const TilePlane& plane, int x, int y, WindowRow& to) {
  float* out = to.values;
  for (int dy = -window_radius; dy <= window_radius; ++dy, out += window_side)
    std::copy_n(plane.row(y + dy) + x - window_radius, window_side, out);
  std::fill(out, to.values + padded_window, 0.0f);
}

void read_inputs(const Tile& tile, int x, int y, WindowInputs& inputs, WindowRow& feature_distances) {
  std::fill_n(feature_distances.values, padded_window, 0.0f);
  const auto add = [&](float floor) { inputs.floor[inputs.count++] = floor; };
  std::fill_n(inputs.rows[0].values, window_size, 1.0f);
  std::fill(inputs.rows[0].values + window_size, inputs.rows[0].values + padded_window, 0.0f);
  inputs.count = 0;
  add(0);
  WindowRow variances;
  for (size_t f = 0; f < feature_count; ++f) {
    float* const values = inputs.rows[inputs.count].values;
    read_window(tile.features[f], x, y, inputs.rows[inputs.count]);
    const float centre = tile.features[f].row(y)[x];
    const float least = f < 3 ? 0.01f : f < 6 ? 0.03f : 0.01f * std::abs(centre) + 1e-6f, floor = least * least;
    float low = 0, high = 0;
    for (int i = 0; i < window_size; ++i) {
      values[i] -= centre;
      low = std::min(low, values[i]);
      high = std::max(high, values[i]);
    }
    if (high - low < 0.1f * least) continue;
    for (size_t half = 0; half < 2; ++half) {
      WindowRow& noisy = inputs.noisy[half][inputs.count - 1];
      read_window(tile.noisy_features[half][f], x, y, noisy);
      for (int i = 0; i < window_size; ++i) noisy.values[i] -= centre;
    }
    read_window(tile.feature_variance[f], x, y, variances);
    float noise = 0;
    for (int i = 0; i < window_size; ++i) noise += variances.values[i];
    noise /= window_size;
    const float scale = 1 / (4 * floor + 2 * noise);
    for (int i = 0; i < window_size; ++i)
      feature_distances.values[i] += std::max(0.0f, values[i] * values[i] - 2 * noise) * scale;
    add(floor);
  }
  for (const bool is_vertical : {false, true}) {
    float* out = inputs.rows[inputs.count].values;
    for (int dy = -window_radius; dy <= window_radius; ++dy)
      for (int dx = -window_radius; dx <= window_radius; ++dx)
        *out++ = static_cast<float>(is_vertical ? dy : dx) / window_radius;
    std::fill(out, inputs.rows[inputs.count].values + padded_window, 0.0f);
    add(0.02f);
  }
}

}  // namespace alhazen::impl::denoising

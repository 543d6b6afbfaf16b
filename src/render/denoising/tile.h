#pragma once

// The working memory of the built-in denoiser: a part of the image, with a margin, in planes.

#include <array>
#include <cstddef>
#include <vector>

#include "render/denoiser.h"
#include "render/denoising/window.h"

namespace alhazen::impl::denoising {

/// Pixels around a tile that planes also hold, so that no access needs a test, and whole lanes can be read.
inline constexpr int plane_padding = window_radius + patch_radius + lanes;

/// Pixels x0 <= x < x1, y0 <= y < y1.
struct Region {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  /// This region with `margin` more pixels on each side, within `bounds`.
  Region grown(int margin, const Region& bounds) const;
};

/// One float for each pixel of a tile and of its padding; (0, 0) is the tile's first pixel.
class TilePlane {
 public:
  TilePlane() = default;
  /// Throws std::bad_alloc.
  TilePlane(int width, int height);
  int width() const { return width_; }
  int height() const { return height_; }
  size_t stride() const { return stride_; }
  /// `y`, and the index into the row that is returned, may be within the padding.
  float* row(int y) { return values_.data() + offset(y); }
  const float* row(int y) const { return values_.data() + offset(y); }
  /// Repeats the border within the padding.
  void pad();

 private:
  size_t offset(int y) const { return static_cast<size_t>(y + plane_padding) * stride_ + plane_padding; }

  int width_ = 0, height_ = 0;
  size_t stride_ = 0;
  std::vector<float> values_;
};

using ColourTile = std::array<TilePlane, 3>;

struct Tile {
  Region region;  ///< of the image
  /// What a pixel has is divided by this, about its albedo, so that textures are no part of what is denoised.
  ColourTile divisor;
  std::array<ColourTile, 2> half;      ///< even and odd blocks; both are the mean where a pixel has only one block
  std::array<ColourTile, 2> variance;  ///< of the halves
  TilePlane odd_fraction;              ///< of the weights of a pixel; 1/2 where it has only one block
  TilePlane inside;                    ///< 1 within the tile where a pixel has samples, 0 elsewhere
  std::array<TilePlane, feature_count> features;                       ///< filtered
  std::array<TilePlane, feature_count> feature_variance;               ///< of the means
  std::array<std::array<TilePlane, feature_count>, 2> noisy_features;  ///< of each half, not filtered
};

/// Reads `region` of `image`, whose values are finite, estimates variances and removes fireflies from the halves.
/// Throws std::bad_alloc.
Tile read_tile(const NoisyImage& image, const Region& region, int threads);

/// Replaces each value by the mean of those up to `radius` away, weighted by a tent in both directions.
void blur(TilePlane& plane, int radius, int threads);

}  // namespace alhazen::impl::denoising

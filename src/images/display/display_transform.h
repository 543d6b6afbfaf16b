#pragma once

// From radiance to the values that PNG and JPEG hold: exposure, white balance, tone map, and the curve of sRGB.

#include <array>
#include <cstdint>
#include <span>

#include "images/display/white_balance.h"
#include "images/image.h"

namespace alhazen::impl {

/// Divides R, G and B of a row by its alpha, where that is above 0: from premultiplied to straight colours. `alpha` is
/// the position of A among the channels.
void make_straight(std::span<float> row, const std::array<size_t, 3>& channels, size_t alpha, size_t width);

class DisplayTransform {
 public:
  explicit DisplayTransform(const WriteOptions& options);

  /// sRGB-encoded values in [0, 1] of linear radiance.
  Vec3d operator()(const Vec3d& radiance) const;

  /// Converts a row of an image, as a source fills it (images/image.h), to red, green and blue of each pixel, rounded
  /// to whole numbers from 0 to `largest`. `channels`: positions of R, G and B.
  void encode_row(std::span<const float> row, const std::array<size_t, 3>& channels, unsigned largest,
                  std::span<uint16_t> encoded) const;

 private:
  double factor_;
  bool balances_;
  WhiteBalance balance_;
  ToneMap tone_map_;
};

}  // namespace alhazen::impl

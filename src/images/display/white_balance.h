#pragma once

// White balance: makes light of one colour temperature white, as cameras do.

#include <array>

#include "core/math/vec.h"

namespace alhazen::impl {

/// Adapts linear sRGB from white light of a temperature to D65, by Bradford's method (colour/rgb_space.h). The
/// luminance of that white stays as it is, and so do all colours at d65_temperature.
class WhiteBalance {
 public:
  /// `kelvin` is from min_white_temperature to max_white_temperature; 0 changes nothing.
  explicit WhiteBalance(double kelvin);
  /// Saturated colours may become negative.
  Vec3d operator()(const Vec3d& rgb) const { return {dot(rows_[0], rgb), dot(rows_[1], rgb), dot(rows_[2], rgb)}; }

 private:
  std::array<Vec3d, 3> rows_;
};

/// Estimates the colour of the light from an image, by "shades of gray" (Finlayson and Trezzi 2004): the sixth power of
/// each channel, averaged over the image, is that of the light. The estimate is a temperature: light is warm or cold,
/// and what is green or purple about the mean is ascribed to the surfaces.
class LightColourEstimate {
 public:
  /// Where a channel is above `brightest`, which must be positive, the colour counts as one with that channel, so that
  /// lamps and bright dots do not decide.
  explicit LightColourEstimate(double brightest) : brightest_(brightest) {}

  void add(const Vec3d& radiance, double weight);
  /// In kelvin, a multiple of 50, from `coldest` to `warmest`; that of D65 if no pixel counts.
  double temperature() const;
  static constexpr double warmest = 2000, coldest = 15000;

 private:
  double brightest_;
  Vec3d sums_;
};

}  // namespace alhazen::impl

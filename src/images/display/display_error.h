#pragma once

// How far a luminance and its error are apart on a display.

#include "images/image.h"

namespace alhazen::impl {

/// srgb_encode for values up to 1, 2^x, and the logarithm of positive numbers, of operations that IEEE 754 rounds in
/// one way. Where a decision depends on them, it is the same on every machine, which is not certain of std::pow and
/// std::exp2. The relative error is below 1e-14.
double portable_srgb_encode(double linear);
double portable_exp2(double exponent);
double portable_log2(double value);

/// How a linear luminance becomes a grey value of sRGB from 0 to 1.
struct DisplayCurve {
  double scale = 1;  ///< factor of exposure
  ToneMap tone_map = ToneMap::none;

  double operator()(double luminance) const;
  /// The error of the displayed value where `luminance` has the standard deviation `deviation`: half of the difference
  /// of what is displayed one deviation above and one below.
  double error(double luminance, double deviation) const;
};

}  // namespace alhazen::impl

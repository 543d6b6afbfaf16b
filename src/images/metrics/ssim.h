#pragma once

// Structural similarity.

#include "images/metrics/separable_filter.h"

namespace alhazen::impl {

/// SSIM of each pixel, in [-1, 1], for values in [0, 1]: Wang et al. 2004, "Image Quality Assessment: From Error
/// Visibility to Structural Similarity", with their window and constants.
Plane<double> ssim_map(const Plane<double>& a, const Plane<double>& b);

/// Number of pixels at each border whose window extends beyond the image. Along an axis shorter than the window it is
/// 0: every pixel counts there, with the border repeated.
size_t ssim_margin(size_t extent);

}  // namespace alhazen::impl

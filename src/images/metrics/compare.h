#pragma once

// Difference metrics of two images.

#include <cstdint>

#include "images/image.h"
#include "images/metrics/separable_filter.h"

namespace alhazen::impl {

/// Metrics over the channels R, G, B of linear values unless said otherwise. Pixels that are not finite in one of the
/// images, or in both, are counted and excluded; without any other pixel the metrics are NaN.
struct ImageDifference {
  double mse = 0;             ///< mean squared error
  double rmse = 0;            ///< its root
  double relmse = 0;          ///< mean of (a - b)^2 / (b^2 + 0.01), b the reference
  double relmse_trimmed = 0;  ///< relmse without the 0.1 % of pixels (rounded down) with the largest terms
  double psnr = 0;            ///< dB, of the sRGB-encoded values clamped to [0, 1]; infinite for equal images
  double ssim = 0;  ///< structural similarity of the encoded luminance (Wang et al. 2004), Gaussian window of 11
  double flip = 0;  ///< mean LDR-FLIP (Andersson et al. 2020) at 67 pixels per degree
  double mean_a = 0, mean_b = 0;             ///< mean luminance of each, over all its finite pixels
  double max_abs = 0;                        ///< largest absolute difference of a channel
  int64_t nonfinite_a = 0, nonfinite_b = 0;  ///< pixels with a NaN or infinite channel
  int64_t nonfinite_in_one = 0;              ///< of those, pixels that are finite in the other image
  int64_t compared = 0;                      ///< pixels that are finite in both
};

/// Throws InputError if the sizes differ or an image has neither R, G, B nor a single channel.
ImageDifference compare_images(const Image& a, const Image& b);

/// The same; `flip_map` becomes the FLIP error of each pixel, in [0, 1]. Excluded pixels
/// are black in both images.
ImageDifference compare_images(const Image& a, const Image& b, Plane<float>& flip_map);

/// The image downsampled: each pixel is the mean of `factor` x `factor` pixels; remaining rows and columns at the right
/// and the bottom are dropped. Throws InputError if nothing would be left.
Image reduced(const Image& image, int factor);

/// An image (R, G, B) of the differences: the FLIP error of each pixel through a perceptually ordered colour map.
Image difference_image(const Image& a, const Image& b);

/// Errors in [0, 1] in the colours of that map (R, G, B).
Image error_colours(const Plane<float>& errors);

}  // namespace alhazen::impl

#pragma once

// Measures how much two images differ, as `alhazen compare` does.
//
//   const alhazen::Comparison comparison = alhazen::compare(image, alhazen::read_image("reference.exr"));
//   std::printf("FLIP %g\n", comparison.flip);
//   alhazen::save(alhazen::heat_map(comparison), "difference.png");

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "alhazen/alhazen.h"
#include "alhazen/version.h"

namespace ALHAZEN_NAMESPACE {

/// What is compared.
struct CompareOptions {
  std::string layer;  ///< a layer of both images, for example albedo; empty: R, G and B, or their only channel
  /// Pixels from (x0, y0) to before (x1, y1), from the top left: x0, y0, x1, y1. Absent: all.
  std::optional<std::array<int64_t, 4>> region;
  int reduce = 1;  ///< compares means of so many by so many pixels: less noise, and FLIP as for smaller images
};

/// Measures over three channels of linear values unless said otherwise. Pixels that are not finite in one of the
/// images, or in both, are counted and excluded; without any other pixel the measures are NaN.
struct Comparison {
  double mse = 0;             ///< mean squared error
  double rmse = 0;            ///< its root
  double relmse = 0;          ///< mean of (a - b)^2 / (b^2 + 0.01), b the reference
  double relmse_trimmed = 0;  ///< relmse without the 0.1 % of pixels (rounded down) with the largest terms
  double psnr = 0;            ///< dB, of the sRGB-encoded values clamped to [0, 1]; infinite for equal images
  double ssim = 0;            ///< structural similarity of the encoded luminance (Wang et al. 2004); 1 for equal images
  double flip = 0;            ///< mean FLIP error (Andersson et al. 2020), 67 pixels per degree; 0 for equal images
  double mean_a = 0, mean_b = 0;             ///< mean luminance of each, over all its finite pixels
  double max_abs = 0;                        ///< largest absolute difference of a channel
  int64_t nonfinite_a = 0, nonfinite_b = 0;  ///< pixels with a NaN or infinite channel
  int64_t nonfinite_in_one = 0;              ///< of those, pixels that are finite in the other image
  int64_t compared = 0;                      ///< pixels that are finite in both

  int width = 0, height = 0;  ///< of what was compared
  /// FLIP error of each pixel, 0 to 1, rows from the top down. Excluded pixels are black in both images.
  std::vector<float> flip_map;
};

/// Compares `a` with the reference `b`. Throws InputError if their sizes differ, if there is no such layer, if the
/// region is not within them, or if they have neither R, G, B nor a single channel.
Comparison compare(const RenderedImage& a, const RenderedImage& b, const CompareOptions& options = {});

/// The errors of the pixels as colours, R, G and B: from black over purple and orange to pale yellow.
RenderedImage heat_map(const Comparison& comparison);

}  // namespace ALHAZEN_NAMESPACE

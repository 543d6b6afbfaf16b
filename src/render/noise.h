#pragma once

// A noise target: how large the error of every pixel is, estimated from its samples and those around it, and which
// pixels need no more of them.
//
// docs/noise.md defines the estimate. The variance of a pixel's mean comes from its blocks of samples, v = sum 4 (y_b -
// y)^2 / (n (B - 1)) for B blocks of luminance y_b and n = 4 B samples, y their mean. Samples of `sobol` are spread
// more evenly than independent ones, also over blocks, so the error is smaller than v says. How much smaller is
// measured by the difference of the means of the first half of the samples and of the second. It is one number for each
// pixel, so it is summed over a neighbourhood.

#include <cstdint>
#include <vector>

#include "render/film.h"
#include "render/settings.h"

namespace alhazen::impl {

/// Where a render with a noise target stands.
struct NoiseState {
  double noise = 0;             ///< root mean square of the estimated errors of all pixels
  double below = 0;             ///< fraction of pixels whose estimate is below the target
  double mean_samples = 0;      ///< per pixel
  double expected_samples = 0;  ///< of all pixels together, when every pixel is below the target or has the most
};

/// Pixels are decided on when all that are not finished have one of these numbers of samples: 16, 24, 32, 40 and so on
/// to 64, and from there 2^k times 1, 1.25, 1.5 and 1.75. Returns the smallest that is larger than `samples`. The
/// numbers depend on nothing else, so neither do the decisions: any engine, any size of passes and any interruption
/// lead to the same.
uint32_t next_decision(uint32_t samples);

/// The state of a film whose errors are not known: their root mean square counts as 1, and only finished pixels as
/// below the target. `expected_samples` is 0.
template <class Real>
NoiseState unknown_noise(const Film<Real>& film);

/// With guiding, called before an iteration ends: keeps the variance of each pixel for estimates in the next ones.
template <class Real>
void keep_variances(const Film<Real>& film);

/// Throws std::bad_alloc.
template <class Real>
class NoiseEstimate {
 public:
  NoiseEstimate(const RenderSettings& settings, const Film<Real>& film);

  /// Finishes the pixels whose estimate is below the target. A pixel that is finished remains so.
  void finish_pixels() const;
  NoiseState state() const;

 private:
  void measure_pixels(const RenderSettings& settings);
  void measure_alpha();
  void join_neighbours();

  const Film<Real>& film_;
  double target_;
  uint32_t most_samples_;
  int width_, height_;
  std::vector<float> errors_;     ///< squared, of each pixel by itself; then those that decide
  std::vector<float> of_halves_;  ///< squared, from the difference of two halves
  double mean_square_ = 0;
};

}  // namespace alhazen::impl

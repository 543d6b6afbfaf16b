#pragma once

// Denoisers: their input, and which are available.

#include <string>
#include <vector>

namespace alhazen {

/// The input of a denoiser: three floats per pixel in each buffer, rows from the top.
struct NoisyPicture {
  int width = 0, height = 0;
  std::vector<float> radiance;  ///< linear
  std::vector<float> albedo;    ///< in [0, 1], at the first hit of camera rays
  std::vector<float> normal;    ///< at the first hit, in world space
};

/// Why OptiX's denoiser cannot be used here, and what to do; empty if it can.
std::string optix_denoiser_problem();
/// Returns the denoised radiance of `image`, computed by OptiX's denoiser on GPU `device`. Throws RenderError.
std::vector<float> denoise_by_optix(const NoisyPicture& image, int device);

}  // namespace alhazen

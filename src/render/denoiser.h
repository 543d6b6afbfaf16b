#pragma once

// Denoisers: what they are given, and which there are.

#include <string>
#include <vector>

namespace alhazen {

/// Three floats a pixel each, rows from the top.
struct NoisyPicture {
  int width = 0, height = 0;
  std::vector<float> radiance;  ///< linear
  std::vector<float> albedo;    ///< in [0, 1], of what camera rays meet first
  std::vector<float> normal;    ///< of the same, in world space
};

/// Why OptiX's denoiser cannot be used here, and what to do; empty where it can.
std::string optix_denoiser_problem();
/// Radiance without noise, as in `picture`, by the denoiser of OptiX on GPU `device`. Throws RenderError.
std::vector<float> denoise_by_optix(const NoisyPicture& picture, int device);

}  // namespace alhazen

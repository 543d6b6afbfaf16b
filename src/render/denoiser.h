#pragma once

// Denoisers: their input, and which are available.

#include <memory>
#include <string>
#include <vector>

namespace alhazen {

/// The input of a denoiser: three floats per pixel in each buffer, rows from the top.
struct NoisyImage {
  int width = 0, height = 0;
  std::vector<float> radiance;  ///< linear
  std::vector<float> albedo;    ///< in [0, 1], at the first hit of camera rays
  std::vector<float> normal;    ///< at the first hit, in world space
};

class Denoiser {
 public:
  virtual ~Denoiser() = default;
  virtual std::string name() const = 0;
  /// Why it cannot be used here, and what to do; empty if it can.
  virtual std::string problem() const = 0;
  /// Returns the denoised radiance of `image`. Runs on GPU `device` if it needs one. Throws RenderError.
  virtual std::vector<float> denoise(const NoisyImage& image, int device) const = 0;
};

/// Every denoiser that this program knows, available or not (backends/registry.cpp).
std::vector<std::unique_ptr<Denoiser>> all_denoisers();
/// The one called `name`. Throws InputError if there is none.
std::unique_ptr<Denoiser> make_denoiser(const std::string& name);

}  // namespace alhazen

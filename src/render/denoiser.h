#pragma once

// Denoisers: their input, and which are available.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace alhazen::impl {

/// The means of each pixel over all its samples, and over the odd ones of its blocks. The means over odd and over even
/// blocks are independent of each other, so their difference tells how noisy the pixel is.
struct NoisyBuffer {
  std::vector<float> mean;
  std::vector<float> odd;  ///< 0 where there is no odd block
};

/// The input of a denoiser. Buffers have three floats per pixel, `depth` one, rows from the top. Camera rays that hit
/// nothing count as black, without normal, and with depth 0.
struct NoisyImage {
  int width = 0, height = 0;
  NoisyBuffer radiance;     ///< linear
  NoisyBuffer albedo;       ///< in [0, 1], of the first surface, or of the first that is not perfectly specular
  NoisyBuffer normal;       ///< likewise, in world space
  NoisyBuffer depth;        ///< likewise, in scene units
  std::vector<float> hits;  ///< the fraction of camera rays that hit a surface
  /// The part of the weights of a pixel that is in odd blocks, in (0, 1), or 0 if it has no two halves of positive
  /// weight. The radiance of even blocks is (mean - odd_fraction odd) / (1 - odd_fraction).
  std::vector<float> odd_fraction;
  std::vector<float> variance;    ///< of the luminance of one sample, unbiased; 0 where there is only one
  std::vector<uint32_t> samples;  ///< of each pixel

  size_t pixels() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }
};

/// Bytes that denoise() takes at most for an image of this many pixels: 96 a pixel for a NoisyImage, 12 for the result,
/// and 32 to mix both. Denoisers take more on their own: `builtin` some 130 MB for a tile, whatever the image's size;
/// `oidn` three more copies of colours (36 bytes a pixel), and what its library takes.
constexpr uint64_t denoising_bytes(uint64_t pixels) { return 140 * pixels; }

/// How and where denoisers run.
struct DenoiseOptions {
  int device = 0;   ///< number of the GPU
  int threads = 1;  ///< of the CPU
};

class Denoiser {
 public:
  virtual ~Denoiser() = default;
  virtual std::string name() const = 0;
  /// What it is, in a few words.
  virtual std::string details() const = 0;
  /// Why it cannot be used here, and what to do; empty if it can.
  virtual std::string problem() const = 0;
  /// What is wrong with it if it is here and cannot be used; empty if it is not here.
  virtual std::string defect() const { return {}; }
  /// Returns the denoised radiance of `image`, three floats per pixel. Throws RenderError, std::bad_alloc.
  virtual std::vector<float> denoise(const NoisyImage& image, const DenoiseOptions& options) const = 0;
};

/// Every denoiser that this program knows, the best first, available or not (backends/registry.cpp).
std::vector<std::unique_ptr<Denoiser>> all_denoisers();
/// The one called `name`. Throws InputError if there is none.
std::unique_ptr<Denoiser> make_denoiser(const std::string& name);

/// The result of choose_denoiser.
struct ChosenDenoiser {
  std::string name;     ///< empty: none
  std::string warning;  ///< why a better one that is here was not taken
};

/// Chooses by what was asked: a name, `auto` for the best that can be used here, `none` or an empty string. Throws
/// InputError if there is none of that name, or if it cannot be used here.
ChosenDenoiser choose_denoiser(const std::string& asked);

/// The name of the best denoiser after the one called `name` that can be used here; empty if there is none.
std::string next_denoiser(const std::string& name);

/// Denoises with the one called `name` and mixes the result with the noisy image by their estimated errors, so that it
/// converges to what the render converges to (render/denoising/blend.h). Pixels that are not finite are replaced by the
/// mean of their neighbours before. Throws as Denoiser::denoise.
std::vector<float> denoise(const std::string& name, NoisyImage image, const DenoiseOptions& options);

}  // namespace alhazen::impl

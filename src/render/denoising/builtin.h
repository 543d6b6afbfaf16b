#pragma once

// The built-in denoiser, with what its tests vary.

#include <vector>

#include "render/denoiser.h"
#include "render/denoising/kernels.h"

namespace alhazen::impl::denoising {

/// Images are denoised in squares of this many pixels.
inline constexpr int default_tile_size = 512;

/// Denoises `image`, whose values are finite and about 1, in tiles. Any size of tiles, kernels and number of threads
/// give the same values, tiles but for rounding. Throws std::bad_alloc.
std::vector<float> denoise_in_tiles(const NoisyImage& image, int tile_size, const Kernels& kernels, int threads);

}  // namespace alhazen::impl::denoising

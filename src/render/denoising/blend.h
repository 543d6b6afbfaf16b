#pragma once

// Mixes a denoised image with the noisy one.

#include <vector>

#include "render/denoiser.h"

namespace alhazen::impl::denoising {

/// Moves pixels of `denoised` towards the noisy ones where they differ by more than noise explains, so that the image
/// converges with more samples to what the render converges to, whatever the denoiser did; and where there is so little
/// noise that it is hardly seen. Pixels with too few samples to know their noise stay as they are. Throws
/// std::bad_alloc.
void blend_with_noisy(const NoisyImage& noisy, std::vector<float>& denoised, int threads);

/// Gives pixels without samples the mean of their neighbours, from those that have samples inwards. The number of their
/// samples stays 0.
void fill_gaps(NoisyImage& image);

/// Replaces pixels of `image` that are not finite by the mean of their finite neighbours, or by black.
/// Returns their number.
size_t repair(NoisyImage& image);

}  // namespace alhazen::impl::denoising

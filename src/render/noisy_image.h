#pragma once

// Makes the input of denoisers from a film.

#include "render/denoiser.h"
#include "render/film.h"

namespace alhazen::impl {

/// `film` was made for denoising. Throws std::bad_alloc.
template <class Real>
NoisyImage make_noisy_image(const Film<Real>& film);

}  // namespace alhazen::impl

#pragma once

// The FLIP error: what an observer sees when flipping between two images.

#include <array>

#include "images/metrics/separable_filter.h"

namespace alhazen::impl {

/// R, G, B, linear, in [0, 1].
using ColourPlanes = std::array<Plane<float>, 3>;

/// LDR-FLIP of each pixel, in [0, 1], after Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating
/// Images", at 67 pixels per degree: a display 0.7 m wide with 3840 pixels, seen from 0.7 m. Symmetric in its
/// arguments.
Plane<float> flip_map(const ColourPlanes& test, const ColourPlanes& reference);

}  // namespace alhazen::impl

#pragma once

// The part of scene compilation that integrates the emission textures of shapes.

#include <cstdint>
#include <vector>

#include "compile/scene_arrays.h"

namespace alhazen::impl {

/// Multiplies the measures of textured lights by the mean luminance of their texture over the shape, estimated at
/// points all over it. A light that is black at all of them gets the measure 0: it is never sampled, and only BSDF
/// sampling finds it. `is_new`, by light, selects those that are to be multiplied; empty: all.
template <class Real>
void weigh_emission_textures(const SceneView<Real>& view, const std::vector<uint8_t>& is_new,
                             std::vector<double>& measures);

}  // namespace alhazen::impl

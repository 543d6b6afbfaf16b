#pragma once

// The part of scene compilation that integrates the emission textures of shapes.

#include <vector>

#include "compile/scene_arrays.h"

namespace alhazen::impl {

/// Multiplies the measures of textured lights by the mean luminance of their texture over the shape, estimated at
/// points all over it. A light that is black at all of them gets the measure 0: it is never sampled, and only BSDF
/// sampling finds it.
template <class Real>
void weigh_emission_textures(const SceneArrays<Real>& arrays, std::vector<double>& measures);

}  // namespace alhazen::impl

#pragma once

// The part of compiling that asks how much the textures of shapes that shine let through.

#include <vector>

#include "compile/scene_arrays.h"

namespace alhazen {

/// Multiplies the measures of lights that have a texture by its mean over the shape, by luminance, as found at points
/// all over it. One that is black at all of them gets the measure 0: it is never sampled, and shines where a path comes
/// upon it.
template <class Real>
void weigh_emission_textures(const SceneArrays<Real>& arrays, std::vector<double>& measures);

}  // namespace alhazen

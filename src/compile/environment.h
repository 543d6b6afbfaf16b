#pragma once

// The part of compiling that places environment maps and gives their texels probabilities.

#include "compile/scene_arrays.h"
#include "scene/scene.h"

namespace alhazen {

/// Appends the map of `light` to out.environments and the light to out.lights, unless it is black. The map's texels
/// move out of the scene. Throws InputError for maps that are none: of another aspect, or with values that are not
/// finite.
template <class Real>
void add_environment(const Light& light, Scene& scene, SceneArrays<Real>& out);

}  // namespace alhazen

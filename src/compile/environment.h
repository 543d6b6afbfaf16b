#pragma once

// The part of scene compilation that adds environment maps and their sampling distributions.

#include "compile/light_maps.h"
#include "compile/scene_arrays.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// Appends the map of `light` to out.environments and the light to out.lights, unless it is black. The map's texels are
/// moved out of the scene, unless `maps` has them: then they are in the arrays already. Returns the part of the light
/// that is above the mean over all directions, which is what light sampling finds. Throws InputError for invalid maps:
/// of a wrong aspect ratio, or with values that are not finite.
template <class Real>
double add_environment(const Light& light, Scene& scene, LightMaps<Real>& maps, SceneArrays<Real>& out);

}  // namespace alhazen::impl

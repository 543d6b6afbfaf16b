#pragma once

// Builds the light tree by which `path` chooses one of many lights (core/lights/light_tree.h).

#include <vector>

#include "compile/scene_arrays.h"

namespace alhazen::impl {

/// Fills out.light_tree with the finite lights whose weight, their power, is above 0, of which there is at least one;
/// each gets its trail.
/// `shapes` has the primitives that lights refer to.
template <class Real>
void build_light_tree(const std::vector<double>& weights, const SceneView<Real>& shapes, SceneArrays<Real>& out);

}  // namespace alhazen::impl

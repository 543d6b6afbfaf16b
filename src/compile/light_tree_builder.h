#pragma once

// The tree that `path` chooses one of many lights by (core/lights/light_tree.h).

#include <vector>

#include "compile/scene_arrays.h"

namespace alhazen {

/// Fills out.light_tree with the lights of finite distance whose weight, their power, is above 0, at least one of them;
/// each is told its trail.
template <class Real>
void build_light_tree(const std::vector<double>& weights, SceneArrays<Real>& out);

}  // namespace alhazen

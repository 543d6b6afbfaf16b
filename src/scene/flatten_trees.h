#pragma once

// The part of flattening that builds the trees of the world and of its objects.

#include "scene/flatten.h"
#include "scene/scene_arrays.h"

namespace alhazen {

/// Fills the trees that `options` asks for and `primitives`, and brings triangles into the order of the leaves. The
/// world's triangles must come first in out.triangles, then those of each object one after the other; the roots are
/// written into out.objects. Adds what statistics say of trees.
template <class Real>
void build_trees(const FlattenOptions& options, SceneArrays<Real>& out, SceneStatistics& statistics);

}  // namespace alhazen

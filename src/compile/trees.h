#pragma once

// The part of compiling that builds the trees of the world and of its objects.

#include "compile/compile_scene.h"
#include "compile/scene_arrays.h"

namespace alhazen::impl {

/// Fills the trees that `options` asks for and `primitives`, and brings triangles into the order of the leaves. The
/// world's triangles must come first in out.triangles, then those of each object one after the other; the roots are
/// written into out.objects. Adds what statistics say of trees.
template <class Real>
void build_trees(const CompileOptions& options, SceneArrays<Real>& out, SceneStatistics& statistics);

}  // namespace alhazen::impl

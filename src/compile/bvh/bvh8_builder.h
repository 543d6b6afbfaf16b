#pragma once

// Collapses the binary BVH into the BVH8 of CPUs (core/bvh/bvh8/node.h).

#include <span>

#include "compile/scene_arrays.h"

namespace alhazen::impl {

/// Collapses `tree`, a binary tree over the primitives from `first_primitive` on with bounds `boxes`, and appends it to
/// bvh8_nodes and the blocks of `scene`, root first. `threads` = 0 uses OpenMP's default. Throws InputError if there
/// are more nodes or blocks than Bvh8Child can index.
template <class Real>
void build_bvh8(std::span<const Bvh2Node<Real>> tree, std::span<const Bounds3<Real>> boxes, uint32_t first_primitive,
                int threads, SceneArrays<Real>& scene);

}  // namespace alhazen::impl

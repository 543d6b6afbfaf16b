#pragma once

// Collapses the binary BVH into the BVH8 of CPUs (core/bvh/bvh8/node.h).

#include <span>

#include "compile/scene_arrays.h"

namespace alhazen {

/// Appends to bvh8_nodes and the blocks of `scene` the collapsed `tree`, a binary tree over the primitives from
/// `first_primitive` on, whose boxes are `boxes`; the root comes first. `threads` 0: as OpenMP has it. Throws
/// InputError where there are more nodes or blocks than Bvh8Child can number.
template <class Real>
void build_bvh8(std::span<const Bvh2Node<Real>> tree, std::span<const Bounds3<Real>> boxes, uint32_t first_primitive,
                int threads, SceneArrays<Real>& scene);

}  // namespace alhazen

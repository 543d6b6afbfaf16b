#pragma once

// Makes the BVH that CPUs walk (core/bvh/bvh8/node.h) from the binary one.

#include <span>

#include "compile/scene_arrays.h"

namespace alhazen {

/// Appends to bvh8_nodes and the blocks of `scene` what stands for `tree`, a binary tree over the primitives from
/// `first_primitive` on, whose boxes are `boxes`; the root comes first. `threads` 0: as OpenMP has it. Throws
/// InputError where there are more nodes or blocks than Bvh8Child can number.
template <class Real>
void build_bvh8(std::span<const Bvh2Node<Real>> tree, std::span<const Bounds3<Real>> boxes, uint32_t first_primitive,
                int threads, SceneArrays<Real>& scene);

}  // namespace alhazen

#pragma once

// Makes the BVH that CPUs walk (core/bvh/simd_node.h) from the binary one.

#include <span>

#include "scene/scene_arrays.h"

namespace alhazen {

/// Fills simd_nodes and the blocks of `scene` from `tree`, a binary tree over scene.primitives, whose boxes are
/// `boxes`. `threads` 0: as OpenMP has it.
template <class Real>
void build_simd_bvh(std::span<const BvhNode<Real>> tree, std::span<const Bounds3<Real>> boxes, int threads,
                    SceneArrays<Real>& scene);

}  // namespace alhazen

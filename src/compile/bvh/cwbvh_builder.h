#pragma once

// Collapses the binary BVH into the compressed wide one.

#include <span>
#include <vector>

#include "core/bvh/bvh2/node.h"
#include "core/bvh/cwbvh/node.h"

namespace alhazen::impl {

struct Cwbvh {
  std::vector<CwbvhNode> nodes;  ///< the root first; empty if there are no primitives
  /// Positions in the binary tree's order of primitives, in the order of the leaves.
  std::vector<uint32_t> primitives;
};

/// Collapses a binary tree with minimal SAH cost, by dynamic programming (Ylitie, Karras, Laine 2017, section 3.2).
/// `boxes` bound the primitives in the order of the binary tree's leaves.
Cwbvh build_cwbvh(std::span<const Bvh2Node<float>> nodes, std::span<const Bounds3<float>> boxes);

}  // namespace alhazen::impl

#pragma once

// Collapses the binary BVH into the compressed wide one.

#include <span>
#include <vector>

#include "core/bvh/bvh2/node.h"
#include "core/bvh/cwbvh/node.h"

namespace alhazen {

struct Cwbvh {
  std::vector<CwbvhNode> nodes;  ///< the root first; empty where there was no primitive
  /// Positions in the binary tree's order of primitives, in the order of the leaves.
  std::vector<uint32_t> primitives;
};

/// `boxes` bound the primitives in the order of the binary tree's leaves. The collapse is the one of least surface area
/// cost, by dynamic programming (Ylitie, Karras, Laine 2017, section 3.2).
Cwbvh build_cwbvh(std::span<const Bvh2Node<float>> nodes, std::span<const Bounds3<float>> boxes);

}  // namespace alhazen

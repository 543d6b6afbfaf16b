#pragma once

// Builds the binary BVH on the host: binned surface area heuristic, in parallel, the same tree for any thread count.

#include <cstdint>
#include <span>
#include <vector>

#include "core/bvh/node.h"

namespace alhazen {

template <class Real>
struct BvhTree {
  std::vector<BvhNode<Real>> nodes;  ///< depth-first; empty where there were no boxes
  /// Leaves refer to ranges of this: the boxes' indices in the order of the leaves.
  std::vector<uint32_t> order;
};

/// `boxes` must be finite and not empty. `threads` 0: as OpenMP has it.
template <class Real>
BvhTree<Real> build_bvh(std::span<const Bounds3<Real>> boxes, int threads);

}  // namespace alhazen

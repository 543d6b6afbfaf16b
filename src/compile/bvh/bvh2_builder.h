#pragma once

// Builds the binary BVH on the host in parallel, with the binned SAH. The tree does not depend on the thread count.

#include <cstdint>
#include <span>
#include <vector>

#include "core/bvh/bvh2/node.h"

namespace alhazen {

template <class Real>
struct Bvh2 {
  std::vector<Bvh2Node<Real>> nodes;  ///< depth-first; empty if there were no boxes
  /// The indices of the boxes in the order of the leaves, which refer to ranges of it.
  std::vector<uint32_t> order;
};

struct Bvh2Options {
  uint32_t max_leaf = 8;        ///< primitives
  double traversal_cost = 1.2;  ///< SAH cost of visiting a node's two children, in units of a primitive test
  int threads = 0;              ///< 0: OpenMP's default

  /// Returns options that split down to single primitives, for a collapse that chooses the leaves.
  static Bvh2Options for_collapse(int threads) { return {4, 1, threads}; }
};

/// `boxes` must be finite and not empty.
template <class Real>
Bvh2<Real> build_bvh2(std::span<const Bounds3<Real>> boxes, const Bvh2Options& options);

}  // namespace alhazen

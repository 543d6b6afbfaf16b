#pragma once

// Builds the binary BVH on the host in parallel, with the binned SAH. The tree does not depend on the thread count.

#include <cstdint>
#include <span>
#include <vector>

#include "core/bvh/bvh2/node.h"

namespace alhazen::impl {

template <class Real>
struct Bvh2 {
  std::vector<Bvh2Node<Real>> nodes;  ///< depth-first; empty if there were no boxes
  /// The indices of the boxes in the order of the leaves, which refer to ranges of it.
  std::vector<uint32_t> order;
};

/// One set for all layouts that are made from the tree: the order of the primitives, by which ties are broken and
/// random numbers of hits are chosen, does not depend on the layout.
struct Bvh2Options {
  uint32_t max_leaf = 4;      ///< primitives
  double traversal_cost = 1;  ///< SAH cost of visiting a node's two children, in units of a primitive test
  int threads = 0;            ///< 0: OpenMP's default
};

/// `boxes` must be finite and not empty.
template <class Real>
Bvh2<Real> build_bvh2(std::span<const Bounds3<Real>> boxes, const Bvh2Options& options);

}  // namespace alhazen::impl

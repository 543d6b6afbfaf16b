#pragma once

// Optimizes a binary BVH by reinserting subtrees where they reduce its surface area (Bittner, Hapala, Havran 2013), in
// batches (Meister and Bittner 2018). The tree does not depend on the thread count.

#include "compile/bvh/bvh2_builder.h"

namespace alhazen::impl {

/// Leaves keep their primitives; nodes and the order of leaves change. A tree that would become deeper than
/// max_bvh2_depth is left as it was.
template <class Real>
void reinsert_subtrees(Bvh2<Real>& tree, int threads);

}  // namespace alhazen::impl

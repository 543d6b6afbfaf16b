#pragma once

// Optimizes a binary BVH by reinsertion: subtrees are moved to where they enlarge others less
// (Bittner, Hapala, Havran 2013; in batches as by Meister and Bittner 2018). The same tree for any thread count.

#include "compile/bvh/bvh2_builder.h"

namespace alhazen {

/// Leaves keep their primitives; nodes and the order of leaves change. A tree that would become deeper than
/// max_bvh2_depth is left as it was.
template <class Real>
void reinsert_subtrees(Bvh2<Real>& tree, int threads);

}  // namespace alhazen

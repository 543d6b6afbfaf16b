#pragma once

// The acceleration structures, for tests that hold for each of them.

#include <gtest/gtest.h>

#include "core/bvh/bvh8/traversal.h"
#include "core/bvh/cwbvh/traversal.h"
#include "isa/queries.h"

namespace alhazen::test {

template <class Any>
struct BinaryTree {
  using Real = Any;
  using Intersector = BvhIntersector<Any>;
};
struct WideTree {
  using Real = float;
  using Intersector = WideBvhIntersector<>;
};

template <class Any>
struct SimdTree {
  using Real = Any;
  using Intersector = SimdBvhIntersector<Any>;
};

/// The same as compiled for one of the instruction sets.
template <class Any, InstructionSet set>
struct IsaTree {
  using Real = Any;
  using Intersector = IsaIntersector<Any, set>;
};

using Trees = ::testing::Types<BinaryTree<float>, BinaryTree<double>, WideTree, SimdTree<float>, SimdTree<double>,
                               IsaTree<float, InstructionSet::avx2>, IsaTree<double, InstructionSet::avx2>,
                               IsaTree<float, InstructionSet::avx512>, IsaTree<double, InstructionSet::avx512>>;

}  // namespace alhazen::test

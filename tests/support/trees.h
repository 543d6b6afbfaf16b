#pragma once

// The trees that answer ray queries, for tests that hold for each of them.

#include <gtest/gtest.h>

#include "core/bvh/simd_traversal.h"
#include "core/bvh/wide.h"

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

using Trees = ::testing::Types<BinaryTree<float>, BinaryTree<double>, WideTree, SimdTree<float>, SimdTree<double>>;

}  // namespace alhazen::test

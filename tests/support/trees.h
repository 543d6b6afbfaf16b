#pragma once

// The trees that answer ray queries, for tests that hold for each of them.

#include <gtest/gtest.h>

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

using Trees = ::testing::Types<BinaryTree<float>, BinaryTree<double>, WideTree>;

}  // namespace alhazen::test

// The tree that the builder makes: complete, nested, of limited depth, and the same for any number of threads.

#include <gtest/gtest.h>

#include "compile/bvh/bvh2_builder.h"
#include "compile/bvh/reinsertion.h"
#include "support/effort.h"
#include "support/random.h"
#include "support/reals.h"

namespace alhazen::impl::test {
namespace {

template <class Real>
using Boxes = std::vector<Bounds3<Real>>;

template <class Real>
Boxes<Real> random_boxes(size_t count, uint64_t seed) {
  Random random(seed);
  Boxes<Real> boxes(count);
  for (Bounds3<Real>& box : boxes) {
    const Vec3d p = random.in_box(-100, 100);
    box.extend(convert<Real>(p));
    box.extend(convert<Real>(p + random.in_box(0, random.magnitude_between(0.01, 10))));
  }
  return boxes;
}

template <class Real>
bool is_within(const Vec3<Real>& low, const Vec3<Real>& high, const Bvh2Node<Real>& parent) {
  const Vec3<Real>&outer_low = parent.low(), &outer_high = parent.high();
  return low.x >= outer_low.x && low.y >= outer_low.y && low.z >= outer_low.z && high.x <= outer_high.x &&
         high.y <= outer_high.y && high.z <= outer_high.z;
}

template <class Real>
void check_tree(const Boxes<Real>& boxes, const Bvh2<Real>& tree) {
  ASSERT_EQ(tree.order.size(), boxes.size());
  std::vector<int> in_leaves(boxes.size());
  std::vector<int> visits(tree.nodes.size());
  struct Visit {
    uint32_t node;
    int depth;
  };
  std::vector<Visit> stack{{0, 0}};
  while (!stack.empty()) {
    const auto [index, depth] = stack.back();
    stack.pop_back();
    ASSERT_LT(index, tree.nodes.size());
    ASSERT_LT(depth, max_bvh2_depth);
    ++visits[index];
    const Bvh2Node<Real>& node = tree.nodes[index];
    if (node.count > 0) {
      for (uint32_t i = node.first; i < node.first + node.count; ++i) {
        ASSERT_LT(i, tree.order.size());
        const uint32_t box = tree.order[i];
        ASSERT_LT(box, boxes.size());
        ++in_leaves[box];
        EXPECT_TRUE(is_within(boxes[box].low, boxes[box].high, node));
      }
      continue;
    }
    ASSERT_LT(node.axis, 3);
    for (const uint32_t child : {node.first, node.first + 1}) {
      ASSERT_LT(child, tree.nodes.size());
      EXPECT_TRUE(is_within(tree.nodes[child].low(), tree.nodes[child].high(), node));
      stack.push_back({child, depth + 1});
    }
  }
  for (const int times : in_leaves) ASSERT_EQ(times, 1);
  for (const int times : visits) ASSERT_EQ(times, 1);
}

/// The tree as built, and after reinsertion of its subtrees.
template <class Real>
void build_and_check(const Boxes<Real>& boxes) {
  Bvh2<Real> tree = build_bvh2<Real>(boxes, {.threads = 1});
  check_tree(boxes, tree);
  reinsert_subtrees(tree, 1);
  check_tree(boxes, tree);
}

/// The sum of the half areas of inner nodes relative to the root's: the expected number that a random ray visits.
template <class Real>
double inner_cost(const Bvh2<Real>& tree) {
  double sum = 0;
  for (const Bvh2Node<Real>& node : tree.nodes)
    if (node.count == 0) sum += static_cast<double>(Bounds3<Real>{node.low(), node.high()}.half_area());
  return sum / static_cast<double>(Bounds3<Real>{tree.nodes[0].low(), tree.nodes[0].high()}.half_area());
}

template <class Real>
void expect_same_tree(const Bvh2<Real>& a, const Bvh2<Real>& b) {
  EXPECT_EQ(a.order, b.order);
  ASSERT_EQ(a.nodes.size(), b.nodes.size());
  for (size_t i = 0; i < a.nodes.size(); ++i) {
    const Bvh2Node<Real>&x = a.nodes[i], &y = b.nodes[i];
    ASSERT_TRUE(x.low() == y.low() && x.high() == y.high() && x.first == y.first && x.count == y.count &&
                x.axis == y.axis);
  }
}

template <class Real>
class BvhBuilderOf : public ::testing::Test {};
TYPED_TEST_SUITE(BvhBuilderOf, Reals);

TYPED_TEST(BvhBuilderOf, RandomBoxes) {
  for (const size_t count : std::initializer_list<size_t>{1, 2, 3, 8, 9, 100, 10'000}) {
    const Boxes<TypeParam> boxes = random_boxes<TypeParam>(count, count);
    build_and_check<TypeParam>(boxes);
  }
}

TYPED_TEST(BvhBuilderOf, NoBoxes) {
  const Bvh2<TypeParam> tree = build_bvh2<TypeParam>(Boxes<TypeParam>{}, {.threads = 1});
  EXPECT_TRUE(tree.nodes.empty());
  EXPECT_TRUE(tree.order.empty());
}

TYPED_TEST(BvhBuilderOf, IdenticalBoxes) {
  using Real = TypeParam;
  Bounds3<Real> box;
  box.extend(Vec3<Real>{1, 2, 3});
  box.extend(Vec3<Real>{2, 3, 4});
  const Boxes<Real> boxes(100'000, box);
  build_and_check<Real>(boxes);
}

TYPED_TEST(BvhBuilderOf, Points) {
  using Real = TypeParam;
  Bounds3<Real> box;
  box.extend(Vec3<Real>{});
  const Boxes<Real> boxes(5000, box);
  build_and_check<Real>(boxes);
}

TYPED_TEST(BvhBuilderOf, FlatGrid) {
  using Real = TypeParam;
  Boxes<Real> boxes;
  for (int x = 0; x < 100; ++x)
    for (int y = 0; y < 100; ++y) {
      boxes.emplace_back();
      boxes.back().extend(Vec3<Real>{static_cast<Real>(x), static_cast<Real>(y), 0});
      boxes.back().extend(Vec3<Real>{static_cast<Real>(x + 1), static_cast<Real>(y + 1), 0});
    }
  build_and_check<Real>(boxes);
}

/// Each box twice as large and twice as far away as the previous one: every split separates one. The deepest tree
/// possible.
TYPED_TEST(BvhBuilderOf, GeometricRow) {
  using Real = TypeParam;
  Boxes<Real> boxes;
  for (int exponent = -120; exponent <= 120; ++exponent)
    for (int copy = 0; copy < 100; ++copy) {
      const Real x = std::ldexp(Real(1), exponent);
      boxes.emplace_back();
      boxes.back().extend(Vec3<Real>{x, x, x});
      boxes.back().extend(Vec3<Real>{x, x, x} * Real(1.5));
    }
  build_and_check<Real>(boxes);
}

/// Boxes of maximum size: areas overflow.
TYPED_TEST(BvhBuilderOf, LargestNumbers) {
  using Real = TypeParam;
  Random random(3);
  Boxes<Real> boxes(2000);
  for (Bounds3<Real>& box : boxes) {
    const Vec3<Real> p = convert<Real>(random.in_box(-1, 1)) * (std::numeric_limits<Real>::max() / 4);
    box.extend(p);
    box.extend(p + convert<Real>(random.in_box(0, 1)) * (std::numeric_limits<Real>::max() / 4));
  }
  build_and_check<Real>(boxes);
}

/// Large enough for the phases that use all threads.
TYPED_TEST(BvhBuilderOf, SameTreeForAnyThreads) {
  using Real = TypeParam;
  const Boxes<Real> boxes = random_boxes<Real>(200'000, 5);
  const Bvh2<Real> one = build_bvh2<Real>(boxes, {.threads = 1});
  check_tree(boxes, one);
  for (const int threads : {2, 3, 8}) expect_same_tree(build_bvh2<Real>(boxes, {.threads = threads}), one);
}

TYPED_TEST(BvhBuilderOf, SameMovesForAnyThreads) {
  using Real = TypeParam;
  const Boxes<Real> boxes = random_boxes<Real>(effort(50'000), 6);
  const Bvh2<Real> built = build_bvh2<Real>(boxes, {.threads = 1});
  Bvh2<Real> one = built;
  reinsert_subtrees(one, 1);
  check_tree(boxes, one);
  for (const int threads : {2, 3}) {
    Bvh2<Real> other = built;
    reinsert_subtrees(other, threads);
    expect_same_tree(other, one);
  }
}

/// Small objects on large ones, as on floors and walls: top-down splits enlarge many boxes by the large ones.
TYPED_TEST(BvhBuilderOf, MovesMakeTheTreeCheaper) {
  using Real = TypeParam;
  Boxes<Real> boxes = random_boxes<Real>(20'000, 7);
  Random random(8);
  for (size_t i = 0; i < boxes.size(); i += 200) {
    const Vec3d p = random.in_box(-100, 100);
    boxes[i].extend(convert<Real>(p));
    boxes[i].extend(convert<Real>(p + Vec3d{80, 0.1, 80}));
  }
  Bvh2<Real> tree = build_bvh2<Real>(boxes, {.threads = 1});
  const double before = inner_cost(tree);
  reinsert_subtrees(tree, 1);
  EXPECT_LT(inner_cost(tree), 0.9 * before);
}

/// Builds a tree that splits the given order into halves.
template <class Real>
Bvh2<Real> halved(const Boxes<Real>& boxes, std::vector<uint32_t> order) {
  Bvh2<Real> tree;
  tree.order = std::move(order);
  tree.nodes.resize(1);
  const auto add = [&](const auto& self, uint32_t node, uint32_t begin, uint32_t end) -> void {
    Bounds3<Real> box;
    for (uint32_t i = begin; i < end; ++i) box.extend(boxes[tree.order[i]]);
    Bvh2Node<Real> n{{box.low, box.high}, begin, 1, 0};
    if (end - begin > 1) {
      n.first = static_cast<uint32_t>(tree.nodes.size());
      n.count = 0;
      tree.nodes.resize(tree.nodes.size() + 2);
      self(self, n.first, begin, (begin + end) / 2);
      self(self, n.first + 1, (begin + end) / 2, end);
    }
    tree.nodes[node] = n;
  };
  add(add, 0, 0, static_cast<uint32_t>(boxes.size()));
  return tree;
}

/// In a row of boxes two have been exchanged in the tree; they return to their neighbours.
TYPED_TEST(BvhBuilderOf, MovesBringBackWhatLiesFarOff) {
  using Real = TypeParam;
  Boxes<Real> boxes(64);
  std::vector<uint32_t> order(boxes.size());
  for (uint32_t i = 0; i < boxes.size(); ++i) {
    boxes[i].extend(Vec3<Real>{static_cast<Real>(i), 0, 0});
    boxes[i].extend(Vec3<Real>{static_cast<Real>(i + 1), 1, 1});
    order[i] = i;
  }
  const double good = inner_cost(halved(boxes, order));
  std::swap(order[3], order[60]);
  Bvh2<Real> tree = halved(boxes, order);
  ASSERT_GT(inner_cost(tree), 1.5 * good);
  for (int times = 0; times < 5; ++times) reinsert_subtrees(tree, 1);
  check_tree(boxes, tree);
  EXPECT_LT(inner_cost(tree), 1.05 * good);
}

}  // namespace
}  // namespace alhazen::impl::test

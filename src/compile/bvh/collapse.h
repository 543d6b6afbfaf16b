#pragma once

// Collapses a binary BVH into nodes with up to 8 children and leaves at minimal SAH cost, by dynamic programming over
// the binary tree (Ylitie, Karras, Laine 2017, section 3.2). The caller defines the cost of leaves.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/bvh/bvh2/node.h"
#include "util/large_array.h"

namespace alhazen::impl {

/// `LeafCost` maps a range (first, count) of primitives, in the order of the leaves, to the cost of a leaf of them in
/// units of a visit to a wide node, or infinity if it may not be a leaf. A single primitive is always a leaf.
template <class Real, class LeafCost>
class BvhCollapse {
 public:
  static constexpr uint32_t max_children = 8;

  /// `boxes` are those of the primitives in the order of the leaves.
  BvhCollapse(std::span<const Bvh2Node<Real>> nodes, std::span<const Bounds3<Real>> boxes, const LeafCost& leaf_cost,
              int threads)
      : source_(nodes),
        boxes_(boxes),
        leaf_cost_(leaf_cost),
        threads_(threads),
        binary_(2 * boxes.size()),
        choices_(2 * boxes.size()) {
    add_node(0);
    choose();
  }

  const Bounds3<Real>& box(uint32_t node) const { return binary_[node].box; }
  uint32_t first(uint32_t node) const { return binary_[node].first; }
  uint32_t count(uint32_t node) const { return binary_[node].count; }
  bool makes_leaf(uint32_t node) const { return choices_[node].makes_leaf; }

  /// Sets `children` to the binary nodes that become the children of the wide node for `node`, and returns how many. If
  /// the tree is one leaf, that is the only child of the root.
  uint32_t children_of(uint32_t node, uint32_t (&children)[max_children]) const {
    uint32_t count = 0;
    if (makes_leaf(node)) {
      children[count++] = node;
      return count;
    }
    gather(node + 1, choices_[node].left[8], children, count);
    gather(binary_[node].right, 8u - choices_[node].left[8], children, count);
    return count;
  }

 private:
  static constexpr uint32_t max_roots = 7;  // of the forest that replaces one child of a node
  static constexpr uint32_t no_child = 0xffffffffu;

  /// The left child of an inner node is the next node.
  struct BinaryNode {
    Bounds3<Real> box;
    uint32_t first, count;  ///< primitives below
    uint32_t right = no_child;
  };

  /// The cheapest forests of at most i wide nodes and leaves that replace a binary node, for i from 1 to 7.
  struct Choices {
    std::array<float, max_roots + 1> cost{};    ///< [i]
    std::array<uint8_t, max_roots + 2> left{};  ///< [i]: roots of the left child; 0: as with i - 1. [8]: of a node
    bool makes_leaf = false;                    ///< with one root: a leaf rather than a node
  };

  void add_node(uint32_t source) {
    const Bvh2Node<Real>& node = source_[source];
    if (node.count > 0) return add_range(node.first, node.count);
    const uint32_t own = binary_count_++;
    binary_[own] = {};
    add_node(node.first);
    join(own, [&] { add_node(node.first + 1); });
  }

  void add_range(uint32_t first, uint32_t count) {
    const uint32_t own = binary_count_++;
    binary_[own] = {};
    if (count == 1 || leaf_cost_(first, count) < std::numeric_limits<float>::infinity()) {
      BinaryNode& node = binary_[own];
      node.first = first;
      node.count = count;
      for (uint32_t i = first; i < first + count; ++i) node.box.extend(boxes_[i]);
      return;
    }
    add_range(first, count / 2);
    join(own, [&] { add_range(first + count / 2, count - count / 2); });
  }

  template <class AddRight>
  void join(uint32_t own, const AddRight& add_right) {
    const uint32_t right = binary_count_;
    add_right();
    BinaryNode& node = binary_[own];
    const BinaryNode &l = binary_[own + 1], &r = binary_[right];
    node.right = right;
    node.first = l.first;
    node.count = l.count + r.count;
    node.box = l.box;
    node.box.extend(r.box);
  }

  /// The nodes below a node stand behind it without gaps: subtrees of some size are chosen for side by side, then the
  /// few nodes above them.
  void choose() {
    std::vector<uint32_t> above;
    std::vector<std::pair<uint32_t, uint32_t>> subtrees;
    std::vector<std::pair<uint32_t, uint32_t>> pending{{0u, binary_count_}};
    constexpr uint32_t subtree_size = 1u << 15;
    while (!pending.empty()) {
      const auto [begin, end] = pending.back();
      pending.pop_back();
      if (end - begin <= subtree_size) {
        subtrees.emplace_back(begin, end);
        continue;
      }
      above.push_back(begin);
      pending.emplace_back(begin + 1, binary_[begin].right);
      pending.emplace_back(binary_[begin].right, end);
    }
#pragma omp parallel for schedule(dynamic) num_threads(threads_)
    for (size_t s = 0; s < subtrees.size(); ++s)
      for (uint32_t i = subtrees[s].second; i-- > subtrees[s].first;) choose_for(i);
    std::sort(above.begin(), above.end());
    for (size_t i = above.size(); i-- > 0;) choose_for(above[i]);
  }

  void choose_for(uint32_t index) {
    const BinaryNode& node = binary_[index];
    Choices& c = choices_[index] = {};
    const float half_area = static_cast<float>(node.box.half_area());
    const float area = half_area < 1e30f ? half_area : 1e30f;
    const bool is_leaf = node.right == no_child;
    const float cost_per_area = leaf_cost_(node.first, node.count);
    // The area of a tiny box is 0 in float, and its product with infinity would be NaN.
    const float leaf_cost = std::isfinite(cost_per_area) ? area * cost_per_area : cost_per_area;
    if (is_leaf) {
      c.makes_leaf = true;
      c.cost.fill(leaf_cost);
      return;
    }
    const Choices &l = choices_[index + 1], &r = choices_[node.right];
    const auto distribute = [&](uint32_t roots) {
      std::pair<float, uint8_t> best{std::numeric_limits<float>::infinity(), uint8_t{1}};
      for (uint32_t left = roots > max_roots ? roots - max_roots : 1; left < roots && left <= max_roots; ++left) {
        const float cost = l.cost[left] + r.cost[roots - left];
        if (cost < best.first) best = {cost, static_cast<uint8_t>(left)};
      }
      return best;
    };
    const auto [inner_cost, inner_left] = distribute(8);
    c.left[8] = inner_left;
    c.makes_leaf = leaf_cost <= inner_cost + area;
    c.cost[1] = std::min(leaf_cost, inner_cost + area);
    for (uint32_t roots = 2; roots <= max_roots; ++roots) {
      const auto [cost, left] = distribute(roots);
      c.cost[roots] = std::min(cost, c.cost[roots - 1]);
      c.left[roots] = cost < c.cost[roots - 1] ? left : uint8_t{0};
    }
  }

  /// Collects the roots of the cheapest forest for binary node `index`.
  void gather(uint32_t index, uint32_t roots, uint32_t (&children)[max_children], uint32_t& count) const {
    const Choices& c = choices_[index];
    while (roots > 1 && c.left[roots] == 0) --roots;
    if (roots == 1) {
      children[count++] = index;
      return;
    }
    gather(index + 1, c.left[roots], children, count);
    gather(binary_[index].right, roots - c.left[roots], children, count);
  }

  std::span<const Bvh2Node<Real>> source_;
  std::span<const Bounds3<Real>> boxes_;
  const LeafCost& leaf_cost_;
  int threads_;
  LargeArray<BinaryNode> binary_;
  uint32_t binary_count_ = 0;
  LargeArray<Choices> choices_;
};

}  // namespace alhazen::impl

#include "scene/wide_bvh_builder.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/bvh/wide.h"

namespace alhazen {

namespace {

/// Cost of a primitive test, in units of a visit to a wide node (the paper's ratio).
constexpr float primitive_cost = 0.3f;
constexpr int most_roots = 7;  // of a forest that stands for one child and its siblings
constexpr uint32_t no_child = 0xffffffffu;

/// A binary node over at most most_wide_leaf primitives, or with two children behind it.
struct BinaryNode {
  Bounds3<float> box;
  uint32_t first, count;  ///< primitives below
  uint32_t left = no_child, right = no_child;

  bool is_leaf() const { return left == no_child; }
};

/// The cheapest ways to stand for a binary node by a forest of at most i wide nodes and leaves, i from 1 to 7.
struct Choices {
  std::array<float, most_roots + 1> cost{};  ///< [i]
  std::array<uint8_t, most_roots + 2>
      left{};               ///< [i]: roots that the left child gets; 0: as with i - 1. [8]: of a node
  bool makes_leaf = false;  ///< with one root: a leaf rather than a node
};

/// What has a place among the children of a wide node.
struct Child {
  uint32_t node;
  uint32_t slot;
};

class Collapse {
 public:
  Collapse(std::span<const BvhNode<float>> nodes, std::span<const Bounds3<float>> boxes)
      : source_(nodes), boxes_(boxes) {
    binary_.reserve(nodes.size() + boxes.size() / 2);
    add_node(0);
    choose();
  }

  WideBvh run() {
    std::vector<uint32_t> pending{0};  // binary nodes that become wide ones, in the order of the wide nodes
    out_.primitives.reserve(boxes_.size());
    for (size_t i = 0; i < pending.size(); ++i) {
      std::vector<Child> children = children_of(pending[i]);
      assign_slots(pending[i], children);
      WideNode node = encode(pending[i], children);
      node.first_child = static_cast<uint32_t>(pending.size());
      node.first_primitive = static_cast<uint32_t>(out_.primitives.size());
      uint32_t offset = 0;
      for (const Child& child : children) {
        uint32_t meta;
        if (choices_[child.node].makes_leaf) {
          const BinaryNode& leaf = binary_[child.node];
          meta = ((1u << leaf.count) - 1) << 5 | offset;
          for (uint32_t p = 0; p < leaf.count; ++p) out_.primitives.push_back(leaf.first + p);
          offset += leaf.count;
        } else {
          meta = 1u << 5 | (24 + child.slot);
          node.exponents_and_inner |= 1u << (24 + child.slot);
          pending.push_back(child.node);
        }
        set_byte(node.meta, child.slot, meta);
      }
      out_.nodes.push_back(node);
    }
    return std::move(out_);
  }

 private:
  // ---- the binary tree with small leaves -------------------------------------------------------------------------

  uint32_t add_node(uint32_t source) {
    const BvhNode<float>& node = source_[source];
    if (node.count > 0) return add_range(node.first, node.count);
    const uint32_t own = static_cast<uint32_t>(binary_.size());
    binary_.emplace_back();
    const uint32_t left = add_node(node.first), right = add_node(node.first + 1);
    join(own, left, right);
    return own;
  }

  uint32_t add_range(uint32_t first, uint32_t count) {
    const uint32_t own = static_cast<uint32_t>(binary_.size());
    binary_.emplace_back();
    if (count > most_wide_leaf) {
      const uint32_t left = add_range(first, count / 2), right = add_range(first + count / 2, count - count / 2);
      join(own, left, right);
      return own;
    }
    BinaryNode& node = binary_[own];
    node.first = first;
    node.count = count;
    for (uint32_t i = first; i < first + count; ++i) node.box.extend(boxes_[i]);
    return own;
  }

  void join(uint32_t own, uint32_t left, uint32_t right) {
    BinaryNode& node = binary_[own];
    node.left = left;
    node.right = right;
    node.first = binary_[left].first;
    node.count = binary_[left].count + binary_[right].count;
    node.box = binary_[left].box;
    node.box.extend(binary_[right].box);
  }

  // ---- the cheapest collapse -------------------------------------------------------------------------------------

  void choose() {
    choices_.resize(binary_.size());
    // Children stand behind their parents.
    for (size_t i = binary_.size(); i-- > 0;) choose_for(static_cast<uint32_t>(i));
  }

  void choose_for(uint32_t index) {
    const BinaryNode& node = binary_[index];
    Choices& c = choices_[index];
    const float half_area = node.box.half_area();
    const float area = half_area < 1e30f ? half_area : 1e30f;
    const float leaf_cost = node.count <= most_wide_leaf ? area * static_cast<float>(node.count) * primitive_cost
                                                         : std::numeric_limits<float>::infinity();
    if (node.is_leaf()) {
      c.makes_leaf = true;
      c.cost.fill(leaf_cost);
      return;
    }
    const auto distribute = [&](int roots) {
      std::pair<float, uint8_t> best{std::numeric_limits<float>::infinity(), uint8_t{1}};
      for (int left = std::max(1, roots - most_roots); left < roots && left <= most_roots; ++left) {
        const float cost = choices_[node.left].cost[static_cast<size_t>(left)] +
                           choices_[node.right].cost[static_cast<size_t>(roots - left)];
        if (cost < best.first) best = {cost, static_cast<uint8_t>(left)};
      }
      return best;
    };
    const auto [inner_cost, inner_left] = distribute(8);
    c.left[8] = inner_left;
    c.makes_leaf = leaf_cost <= inner_cost + area;
    c.cost[1] = std::min(leaf_cost, inner_cost + area);
    for (int roots = 2; roots <= most_roots; ++roots) {
      const auto [cost, left] = distribute(roots);
      const size_t i = static_cast<size_t>(roots);
      c.cost[i] = std::min(cost, c.cost[i - 1]);
      c.left[i] = cost < c.cost[i - 1] ? left : uint8_t{0};
    }
  }

  /// The roots of the cheapest forest for binary node `index`.
  void gather(uint32_t index, uint32_t roots, std::vector<Child>& children) const {
    const Choices& c = choices_[index];
    while (roots > 1 && c.left[roots] == 0) --roots;
    if (roots == 1) {
      children.push_back({index, 0});
      return;
    }
    gather(binary_[index].left, c.left[roots], children);
    gather(binary_[index].right, roots - c.left[roots], children);
  }

  std::vector<Child> children_of(uint32_t index) const {
    std::vector<Child> children;
    const Choices& c = choices_[index];
    if (c.makes_leaf) {  // the whole tree is one leaf
      children.push_back({index, 0});
      return children;
    }
    gather(binary_[index].left, c.left[8], children);
    gather(binary_[index].right, 8u - c.left[8], children);
    return children;
  }

  // ---- one wide node ---------------------------------------------------------------------------------------------

  /// Gives each child the slot whose octant it lies in, as far as slots are free, the clearest cases first; then sorts
  /// by slot. A ray goes first to the slot whose bits say where its direction is negative.
  void assign_slots(uint32_t index, std::vector<Child>& children) const {
    const Vec3<float> middle = binary_[index].box.center();
    struct Pair {
      float cost;
      uint32_t child, slot;
    };
    std::vector<Pair> pairs;
    for (uint32_t c = 0; c < children.size(); ++c) {
      const Vec3<float> offset = binary_[children[c].node].box.center() - middle;
      for (uint32_t slot = 0; slot < WideNode::children; ++slot)
        pairs.push_back(
            {(slot & 1 ? -offset.x : offset.x) + (slot & 2 ? -offset.y : offset.y) + (slot & 4 ? -offset.z : offset.z),
             c, slot});
    }
    // Numbers that are none, of boxes beyond all bounds, must not upset the order.
    for (Pair& pair : pairs)
      if (std::isnan(pair.cost)) pair.cost = 0;
    std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.cost < b.cost; });
    uint32_t placed = 0, used = 0;
    for (const Pair& pair : pairs) {
      if (placed >> pair.child & 1 || used >> pair.slot & 1) continue;
      children[pair.child].slot = pair.slot;
      placed |= 1u << pair.child;
      used |= 1u << pair.slot;
    }
    std::sort(children.begin(), children.end(), [](const Child& a, const Child& b) { return a.slot < b.slot; });
  }

  static void set_byte(uint32_t words[2], uint32_t child, uint32_t value) {
    words[child / 4] |= value << (8 * (child % 4));
  }

  WideNode encode(uint32_t index, const std::vector<Child>& children) const {
    WideNode node{};
    node.origin = binary_[index].box.low;
    for (int axis = 0; axis < 3; ++axis) {
      const double extent = static_cast<double>(binary_[index].box.high[axis]) - static_cast<double>(node.origin[axis]);
      int exponent = extent > 0 ? std::clamp(std::ilogb(extent / 255), -126, 127) : -126;
      while (!encode_axis(children, axis, exponent, node)) ++exponent;
      node.exponents_and_inner |= static_cast<uint32_t>(exponent + 127) << (8 * axis);
    }
    return node;
  }

  /// False where the steps are too small for some child's box.
  bool encode_axis(const std::vector<Child>& children, int axis, int exponent, WideNode& node) const {
    const float origin = node.origin[axis], scale = std::ldexp(1.0f, exponent);
    uint32_t low[2]{}, high[2]{};
    for (const Child& child : children) {
      const Bounds3<float>& box = binary_[child.node].box;
      const auto steps_to = [&](float coordinate) {
        return (static_cast<double>(coordinate) - static_cast<double>(origin)) / static_cast<double>(scale);
      };
      const double low_steps = std::floor(steps_to(box.low[axis])), high_steps = std::ceil(steps_to(box.high[axis]));
      if (!(high_steps <= 255)) return false;
      uint32_t down = static_cast<uint32_t>(std::clamp(low_steps, 0.0, 255.0)), up = static_cast<uint32_t>(high_steps);
      // As rounded where rays are tested, the box must hold what it bounds.
      while (down > 0 && box_coordinate(origin, scale, down) > box.low[axis]) --down;
      while (up <= 255 && box_coordinate(origin, scale, up) < box.high[axis]) ++up;
      if (up > 255) return false;
      set_byte(low, child.slot, down);
      set_byte(high, child.slot, up);
    }
    for (int word = 0; word < 2; ++word) {
      node.low[axis][word] = low[word];
      node.high[axis][word] = high[word];
    }
    return true;
  }

  std::span<const BvhNode<float>> source_;
  std::span<const Bounds3<float>> boxes_;
  std::vector<BinaryNode> binary_;
  std::vector<Choices> choices_;
  WideBvh out_;
};

}  // namespace

WideBvh build_wide_bvh(std::span<const BvhNode<float>> nodes, std::span<const Bounds3<float>> boxes) {
  return nodes.empty() ? WideBvh{} : Collapse(nodes, boxes).run();
}

}  // namespace alhazen

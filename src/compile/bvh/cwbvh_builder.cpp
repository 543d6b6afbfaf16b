#include "compile/bvh/cwbvh_builder.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "compile/bvh/collapse.h"
#include "compile/bvh/octant_slots.h"
#include "core/bvh/cwbvh/traversal.h"

namespace alhazen::impl {

namespace {

/// The cost of a leaf: 0.3 of a visit to a wide node per primitive (the paper's ratio).
struct CwbvhLeafCost {
  float operator()(uint32_t, uint32_t count) const {
    return count <= max_cwbvh_leaf ? 0.3f * static_cast<float>(count) : std::numeric_limits<float>::infinity();
  }
};

/// A child of a wide node.
struct Child {
  uint32_t node;
  uint32_t slot;
};

class Collapse {
 public:
  Collapse(std::span<const Bvh2Node<float>> nodes, std::span<const Bounds3<float>> boxes)
      : boxes_(boxes), collapse_(nodes, boxes, cost_, 1) {}

  Cwbvh run() {
    std::vector<uint32_t> pending{0};  // binary nodes that become wide ones, in the order of the wide nodes
    out_.primitives.reserve(boxes_.size());
    for (size_t i = 0; i < pending.size(); ++i) {
      std::vector<Child> children = children_of(pending[i]);
      assign_slots(pending[i], children);
      CwbvhNode node = encode(pending[i], children);
      node.first_child = static_cast<uint32_t>(pending.size());
      node.first_primitive = static_cast<uint32_t>(out_.primitives.size());
      uint32_t offset = 0;
      for (const Child& child : children) {
        uint32_t meta;
        if (collapse_.makes_leaf(child.node)) {
          const uint32_t first = collapse_.first(child.node), count = collapse_.count(child.node);
          meta = ((1u << count) - 1) << 5 | offset;
          for (uint32_t p = 0; p < count; ++p) out_.primitives.push_back(first + p);
          offset += count;
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
  std::vector<Child> children_of(uint32_t index) const {
    uint32_t children[CwbvhNode::children];
    const uint32_t count = collapse_.children_of(index, children);
    std::vector<Child> all;
    for (uint32_t c = 0; c < count; ++c) all.push_back({children[c], 0});
    return all;
  }

  /// Assigns a slot to each child, and sorts the children by slot.
  void assign_slots(uint32_t index, std::vector<Child>& children) const {
    const Vec3<float> middle = collapse_.box(index).centre();
    Vec3<float> offsets[CwbvhNode::children];
    for (uint32_t c = 0; c < children.size(); ++c) offsets[c] = collapse_.box(children[c].node).centre() - middle;
    const std::array<uint32_t, 8> slots = octant_slots(offsets, static_cast<uint32_t>(children.size()));
    for (uint32_t c = 0; c < children.size(); ++c) children[c].slot = slots[c];
    std::sort(children.begin(), children.end(), [](const Child& a, const Child& b) { return a.slot < b.slot; });
  }

  static void set_byte(uint32_t words[2], uint32_t child, uint32_t value) {
    words[child / 4] |= value << (8 * (child % 4));
  }

  CwbvhNode encode(uint32_t index, const std::vector<Child>& children) const {
    CwbvhNode node{};
    node.origin = collapse_.box(index).low;
    for (int axis = 0; axis < 3; ++axis) {
      const double extent =
          static_cast<double>(collapse_.box(index).high[axis]) - static_cast<double>(node.origin[axis]);
      int exponent = extent > 0 ? std::clamp(std::ilogb(extent / 255), -126, 127) : -126;
      while (!encode_axis(children, axis, exponent, node)) ++exponent;
      node.exponents_and_inner |= static_cast<uint32_t>(exponent + 127) << (8 * axis);
    }
    return node;
  }

  /// Quantizes the boxes along one axis. Returns false if the steps are too small for some child's box.
  bool encode_axis(const std::vector<Child>& children, int axis, int exponent, CwbvhNode& node) const {
    const float origin = node.origin[axis], scale = std::ldexp(1.0f, exponent);
    uint32_t low[2]{}, high[2]{};
    for (const Child& child : children) {
      const Bounds3<float>& box = collapse_.box(child.node);
      const auto steps_to = [&](float coordinate) {
        return (static_cast<double>(coordinate) - static_cast<double>(origin)) / static_cast<double>(scale);
      };
      const double low_steps = std::floor(steps_to(box.low[axis])), high_steps = std::ceil(steps_to(box.high[axis]));
      if (!(high_steps <= 255)) return false;
      uint32_t down = static_cast<uint32_t>(std::clamp(low_steps, 0.0, 255.0)), up = static_cast<uint32_t>(high_steps);
      // The box must stay conservative under the rounding of the traversal.
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

  std::span<const Bounds3<float>> boxes_;
  CwbvhLeafCost cost_;
  BvhCollapse<float, CwbvhLeafCost> collapse_;
  Cwbvh out_;
};

}  // namespace

Cwbvh build_cwbvh(std::span<const Bvh2Node<float>> nodes, std::span<const Bounds3<float>> boxes) {
  return nodes.empty() ? Cwbvh{} : Collapse(nodes, boxes).run();
}

}  // namespace alhazen::impl

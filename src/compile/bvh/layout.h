#pragma once

// The BVH layouts that a scene is compiled to.

#include <cstdint>
#include <initializer_list>

namespace alhazen::impl {

enum class BvhLayout : uint32_t {
  bvh2,   ///< binary: GPUs in double, tests
  bvh8,   ///< 8 children per node: CPUs
  cwbvh,  ///< 8 children per node, compressed: GPUs in float
};

/// A set of layouts, which is empty for backends that build their own tree.
class BvhLayouts {
 public:
  constexpr BvhLayouts() = default;
  constexpr BvhLayouts(std::initializer_list<BvhLayout> layouts) {
    for (const BvhLayout layout : layouts) add(layout);
  }

  constexpr void add(BvhLayout layout) { bits_ |= bit(layout); }
  constexpr bool has(BvhLayout layout) const { return (bits_ & bit(layout)) != 0; }
  constexpr bool empty() const { return bits_ == 0; }

 private:
  static constexpr uint32_t bit(BvhLayout layout) { return 1u << static_cast<uint32_t>(layout); }

  uint32_t bits_ = 0;
};

}  // namespace alhazen::impl

#pragma once

// The binary BVH. Nodes are in depth-first order; siblings are adjacent.

#include <cstdint>

#include "core/math/bounds.h"

namespace ALHAZEN_CORE {

/// An inner node has count 0 and its children at `first` and `first + 1`; a leaf has `count` primitives from `first`
/// in SceneView::primitives. `axis` is the split axis of the children.
template <class Real>
struct Bvh2Node {
  Vec3<Real> corners[2];  ///< low and high; an array, so that the slab test can select by index
  uint32_t first;
  uint16_t count;
  uint16_t axis;

  ALHAZEN_HD const Vec3<Real>& low() const { return corners[0]; }
  ALHAZEN_HD const Vec3<Real>& high() const { return corners[1]; }
};

/// Maximum depth of a tree, which the builder guarantees (compile/bvh/bvh2_builder.h).
inline constexpr int max_bvh2_depth = 64;

}  // namespace ALHAZEN_CORE

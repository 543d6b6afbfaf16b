#pragma once

// The binary BVH: nodes in depth-first order, siblings side by side.

#include <cstdint>

#include "core/math/bounds.h"

namespace alhazen {

/// An inner node has count 0 and its children at `first` and `first + 1`; a leaf has `count` primitives from `first`
/// in SceneView::primitives. `axis` is the axis along which the children were parted.
template <class Real>
struct BvhNode {
  Vec3<Real> low, high;
  uint32_t first;
  uint16_t count;
  uint16_t axis;
};

/// No tree is deeper: the builder ends in leaves before (scene/bvh_builder.h).
inline constexpr int max_bvh_depth = 64;

}  // namespace alhazen

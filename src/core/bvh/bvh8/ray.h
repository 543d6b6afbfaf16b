#pragma once

// The slab test of a ray against the boxes of a Bvh8Node, and definitions that single-ray and packet traversal share.

#include <bit>

#include "core/bvh/bvh2/node.h"
#include "core/bvh/bvh8/node.h"
#include "core/math/ray.h"
#include "core/simd/lanes.h"
#include "core/simd/pack.h"

namespace ALHAZEN_CORE {

/// A ray prepared for the slab test: it enters a slab at side * inverse + near_offset and leaves it at side * inverse +
/// far_offset. The test is conservative: the offsets differ by more than the rounding error, and boxes are padded
/// (padded_box), so the box of a primitive that is hit is never missed.
struct BoxRay {
  float inverse[3], near_offset[3], far_offset[3];
  uint32_t near_row[3];  ///< row of Bvh8Node::bounds through which the ray enters, per axis
  uint32_t octant;       ///< bit i is set if the direction is negative along axis i
};

/// Relative padding of rays and boxes: a few times the rounding error of float.
inline constexpr float box_slack = 4e-7f;

/// Minimum magnitude of direction components in the slab test. It keeps offsets finite for coordinates up to 1e20.
inline constexpr float min_direction = 1e-18f;

template <class Real>
ALHAZEN_INLINE BoxRay box_ray(const Ray<Real>& ray) {
  BoxRay b;
  b.octant = 0;
  const float reach = static_cast<float>(max_component(abs(ray.origin)));
  for (int axis = 0; axis < 3; ++axis) {
    const float d = static_cast<float>(ray.direction[axis]);
    const float inverse = 1 / (std::abs(d) > min_direction ? d : std::copysign(min_direction, d));
    const float offset = static_cast<float>(ray.origin[axis] * static_cast<Real>(inverse));
    const float slack = std::abs(inverse) * reach * box_slack;
    b.inverse[axis] = inverse;
    b.near_offset[axis] = -(offset + slack);
    b.far_offset[axis] = -(offset - slack);
    b.near_row[axis] = 2 * static_cast<uint32_t>(axis) + (inverse < 0 ? 1 : 0);
    b.octant |= inverse < 0 ? 1u << axis : 0;
  }
  return b;
}

/// The distances at which a ray enters and leaves the boxes of a node's children.
struct ChildIntervals {
  Lanes<float, bvh8_width> near, far;

  /// Returns a mask of the children that the ray enters.
  ALHAZEN_INLINE uint32_t children() const { return less_equal(near, far); }
};

/// Intersects the ray with the boxes of all children; the intervals are clipped to [0, t_max].
ALHAZEN_INLINE ChildIntervals intersect_children(const Bvh8Node& node, const BoxRay& ray, float t_max) {
  using V = Lanes<float, bvh8_width>;
  const auto side = [&](int axis, uint32_t row, float offset) {
    return fused_multiply_add(V::load(node.bounds[row]), V::all(ray.inverse[axis]), V::all(offset));
  };
  const auto near = [&](int axis) { return side(axis, ray.near_row[axis], ray.near_offset[axis]); };
  const auto far = [&](int axis) { return side(axis, ray.near_row[axis] ^ 1, ray.far_offset[axis]); };
  // NaN counts as inside.
  return {max(max(near(0), near(1)), max(near(2), V::all(0))), min(min(far(0), far(1)), min(far(2), V::all(t_max)))};
}

/// For each octant of ray directions, the approximate order of the children from far to near that their slots imply
/// (compile/bvh/octant_slots.h).
struct OctantOrders {
  uint32_t of_octant[8][bvh8_width];
};

inline constexpr OctantOrders octant_orders = [] {
  OctantOrders orders{};
  for (uint32_t octant = 0; octant < 8; ++octant)
    for (uint32_t i = 0; i < 8; ++i) orders.of_octant[octant][i] = (7 - i) ^ octant;
  return orders;
}();

/// The maximum depth of the tree. Each level leaves at most 7 children on the stack.
inline constexpr int max_bvh8_depth = max_bvh2_depth + 4;
inline constexpr int bvh8_stack_size = (bvh8_width - 1) * max_bvh8_depth + bvh8_width;

/// Returns the t_max of box tests after a hit at t, which is slightly larger because t is rounded.
template <class Real>
ALHAZEN_INLINE float box_t_max(Real t) {
  return static_cast<float>(t) * (1 + 8 * box_slack);
}

/// Returns whether the origin is finite. Otherwise the ray hits nothing and is not traversed.
template <class Real>
ALHAZEN_INLINE bool has_finite_origin(const Ray<Real>& ray) {
  return max_component(abs(ray.origin)) < infinity<Real>;
}

}  // namespace ALHAZEN_CORE

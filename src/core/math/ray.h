#pragma once

// Rays, and where to start a ray so that it does not hit the surface that it leaves.

#include "core/math/field_list.h"
#include "core/math/scalar.h"
#include "core/math/vec.h"
#include "core/shapes/primitive_id.h"

namespace ALHAZEN_CORE {

template <class Real>
struct Ray {
  Vec3<Real> origin;
  Vec3<Real> direction;  ///< unit length
  Real time{};           ///< 0 at shutter open, 1 at shutter close
  /// The primitive that the ray leaves, and its instance. A triangle is flat, so the ray cannot hit it again: the
  /// intersectors skip it, since rounding may place the origin on either side of it.
  PrimitiveId left{};
  uint32_t left_instance = no_instance;

  using Fields = FieldList<&Ray::origin, &Ray::direction, &Ray::time, &Ray::left, &Ray::left_instance>;
};

/// `position` moved off the surface to the side that `direction` points to, by the bound on the error of `position`
/// along the geometric `normal` (Pharr, Jakob, Humphreys: PBR 4th ed., 6.8.6).
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec3<Real> offset_origin(const Vec3<Real>& position, const Vec3<Real>& position_error,
                                                const Vec3<Real>& normal, const Vec3<Real>& direction) {
  const Real distance = dot(abs(normal), position_error);
  const Vec3<Real> offset = normal * (dot(direction, normal) < 0 ? -distance : distance);
  const Vec3<Real> moved = position + offset;
  return {next_towards(moved.x, offset.x), next_towards(moved.y, offset.y), next_towards(moved.z, offset.z)};
}

}  // namespace ALHAZEN_CORE

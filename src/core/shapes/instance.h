#pragma once

// Rays into the space of an instance's object, and surfaces out of it. Distances stay those of the world, since
// directions are not made unit length again.

#include "core/math/ray.h"
#include "core/math/scalar.h"
#include "core/shapes/records.h"

namespace ALHAZEN_CORE {

template <class Real>
ALHAZEN_HD Vec3<Real> transform_direction(const Real (&m)[3][4], const Vec3<Real>& v) {
  return {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z, m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
          m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
}

template <class Real>
ALHAZEN_HD Vec3<Real> transform_point(const Real (&m)[3][4], const Vec3<Real>& p) {
  return transform_direction(m, p) + Vec3<Real>{m[0][3], m[1][3], m[2][3]};
}

/// Sums of the magnitudes of what `transform_point` adds up.
template <class Real>
ALHAZEN_HD Vec3<Real> transformed_magnitude(const Real (&m)[3][4], const Vec3<Real>& p) {
  const auto row = [&](int i) {
    return std::abs(m[i][0] * p.x) + std::abs(m[i][1] * p.y) + std::abs(m[i][2] * p.z) + std::abs(m[i][3]);
  };
  return {row(0), row(1), row(2)};
}

/// Of extents, which have no place: the translation does not count.
template <class Real>
ALHAZEN_HD Vec3<Real> transformed_extent(const Real (&m)[3][4], const Vec3<Real>& e) {
  const auto row = [&](int i) { return std::abs(m[i][0]) * e.x + std::abs(m[i][1]) * e.y + std::abs(m[i][2]) * e.z; };
  return {row(0), row(1), row(2)};
}

/// By the inverse transpose: `inverse` is the transform back. Not of unit length.
template <class Real>
ALHAZEN_HD Vec3<Real> transform_normal(const Real (&inverse)[3][4], const Vec3<Real>& n) {
  return {inverse[0][0] * n.x + inverse[1][0] * n.y + inverse[2][0] * n.z,
          inverse[0][1] * n.x + inverse[1][1] * n.y + inverse[2][1] * n.z,
          inverse[0][2] * n.x + inverse[1][2] * n.y + inverse[2][2] * n.z};
}

template <class Real>
ALHAZEN_HD Ray<Real> object_ray(const InstanceRecord<Real>& instance, const Ray<Real>& ray) {
  return {transform_point(instance.object_from_world, ray.origin),
          transform_direction(instance.object_from_world, ray.direction), ray.time};
}

/// How far a point of the object may be from where it is said to be once a ray that starts there has been brought back
/// into the object's space: its own error, and the rounding of both ways and of both matrices.
template <class Real>
ALHAZEN_HD Vec3<Real> world_position_error(const InstanceRecord<Real>& instance, const Vec3<Real>& object_position,
                                           const Vec3<Real>& object_error, const Vec3<Real>& world_position) {
  const Vec3<Real> way_back =
      transformed_magnitude(instance.object_from_world, world_position) * rounding_bound<Real>(6);
  return transformed_magnitude(instance.world_from_object, object_position) * rounding_bound<Real>(6) +
         transformed_extent(instance.world_from_object, object_error + way_back);
}

/// The primitive that a search within `instance` has to come before at the distance of `hit`: of hits at the same
/// distance that of the lowest primitive counts, of the same primitive that of the lowest instance.
template <class Real>
ALHAZEN_HD PrimitiveId bound_within(uint32_t instance, const Hit<Real>& hit) {
  PrimitiveId bound = hit.primitive;
  bound.bits += instance < hit.instance ? 1 : 0;
  return bound;
}

}  // namespace ALHAZEN_CORE

#pragma once

// Transforms rays from world space to the object space of an instance, and surfaces back. Directions are not
// renormalized in object space, so that t stays the distance in world space.

#include "core/math/ray.h"
#include "core/math/scalar.h"
#include "core/scene_view.h"

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

/// Returns the sums of the magnitudes of the terms that `transform_point` adds.
template <class Real>
ALHAZEN_HD Vec3<Real> transformed_magnitude(const Real (&m)[3][4], const Vec3<Real>& p) {
  const auto row = [&](int i) {
    return std::abs(m[i][0] * p.x) + std::abs(m[i][1] * p.y) + std::abs(m[i][2] * p.z) + std::abs(m[i][3]);
  };
  return {row(0), row(1), row(2)};
}

/// Transforms an extent, to which the translation does not apply.
template <class Real>
ALHAZEN_HD Vec3<Real> transformed_extent(const Real (&m)[3][4], const Vec3<Real>& e) {
  const auto row = [&](int i) { return std::abs(m[i][0]) * e.x + std::abs(m[i][1]) * e.y + std::abs(m[i][2]) * e.z; };
  return {row(0), row(1), row(2)};
}

/// Transforms a normal with the transpose of `inverse`, the inverse transform. The result is not normalized.
template <class Real>
ALHAZEN_HD Vec3<Real> transform_normal(const Real (&inverse)[3][4], const Vec3<Real>& n) {
  return {inverse[0][0] * n.x + inverse[1][0] * n.y + inverse[2][0] * n.z,
          inverse[0][1] * n.x + inverse[1][1] * n.y + inverse[2][1] * n.z,
          inverse[0][2] * n.x + inverse[1][2] * n.y + inverse[2][2] * n.z};
}

/// Computes the inverse of an affine transform, or zero if it is singular.
template <class Real>
ALHAZEN_HD void invert(const Real (&m)[3][4], Real (&inverse)[3][4]) {
  const Vec3<Real> x{m[0][0], m[1][0], m[2][0]}, y{m[0][1], m[1][1], m[2][1]}, z{m[0][2], m[1][2], m[2][2]};
  const Vec3<Real> rows[3] = {cross(y, z), cross(z, x), cross(x, y)};
  const Real determinant = dot(x, rows[0]);
  const Real factor = determinant != 0 ? 1 / determinant : Real(0);
  const Vec3<Real> translation{m[0][3], m[1][3], m[2][3]};
  for (int i = 0; i < 3; ++i) {
    const Vec3<Real> row = rows[i] * factor;
    inverse[i][0] = row.x;
    inverse[i][1] = row.y;
    inverse[i][2] = row.z;
    inverse[i][3] = -dot(row, translation);
  }
}

/// Returns the instance with its transforms at `time`.
template <class Real>
ALHAZEN_HD InstanceRecord<Real> instance_at(const SceneView<Real>& scene, uint32_t index, Real time) {
  InstanceRecord<Real> instance = scene.instances[index];
  if (instance.motion == no_motion) return instance;
  const InstanceMotion<Real>& motion = scene.instance_motions[instance.motion];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) instance.world_from_object[i][j] += motion.change[i][j] * time;
  invert(instance.world_from_object, instance.object_from_world);
  return instance;
}

template <class Real>
ALHAZEN_HD Ray<Real> object_ray(const InstanceRecord<Real>& instance, const Ray<Real>& ray) {
  return {transform_point(instance.object_from_world, ray.origin),
          transform_direction(instance.object_from_world, ray.direction), ray.time};
}

/// Returns the ray in the object space of instance `index`. Its `left` is the triangle of this object that the ray
/// starts on, if any, and its `left_instance` is no_instance.
template <class Real>
ALHAZEN_HD Ray<Real> object_ray(const SceneView<Real>& scene, uint32_t index, const Ray<Real>& ray) {
  const InstanceRecord<Real>& instance = scene.instances[index];
  Ray<Real> inner =
      instance.motion == no_motion ? object_ray(instance, ray) : object_ray(instance_at(scene, index, ray.time), ray);
  if (ray.left_instance == index) inner.left = ray.left;
  return inner;
}

/// Bounds the error of a world space position, including the error of transforming a ray that starts there back to
/// object space: the error of the object space position plus the rounding of both transforms and of both matrices.
template <class Real>
ALHAZEN_HD Vec3<Real> world_position_error(const InstanceRecord<Real>& instance, const Vec3<Real>& object_position,
                                           const Vec3<Real>& object_error, const Vec3<Real>& world_position) {
  Vec3<Real> way_back = transformed_magnitude(instance.object_from_world, world_position) * rounding_bound<Real>(6);
  if (instance.motion != no_motion)  // the inverse is computed in Real, so entries that should be 0 may not be
    way_back = splat(max_component(transformed_magnitude(instance.object_from_world, world_position)) *
                     rounding_bound<Real>(32));
  return transformed_magnitude(instance.world_from_object, object_position) * rounding_bound<Real>(6) +
         transformed_extent(instance.world_from_object, object_error + way_back);
}

}  // namespace ALHAZEN_CORE

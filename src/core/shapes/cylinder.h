#pragma once

// Cylinders without caps, whole or in part, under any affine map: intersection in object space, bounds, and the surface
// at a hit.

#include "core/math/bounds.h"
#include "core/math/ray.h"
#include "core/math/scalar.h"
#include "core/scene_view.h"
#include "core/shapes/record_lanes.h"
#include "core/shapes/sheared_ray.h"
#include "core/shapes/surface_interaction.h"

namespace ALHAZEN_CORE {

/// Hits of cylinders, one per lane, or one alone.
template <class V>
struct CylinderLanes {
  V t;
  uint32_t crossed = 0;  ///< one bit per lane whose cylinder may be hit; if none is set, `t` is not computed

  template <class Real>
  ALHAZEN_INLINE void fill(int, Hit<Real>& hit) const {
    hit.b1 = hit.b2 = 0;
  }
};

/// Intersects rays with cylinders, in object space. As for spheres, the discriminant is computed from the point that is
/// closest to the axis, and the roots without cancellation (Haines, Gunther, Akenine-Moller 2019, Ray Tracing Gems
/// ch. 7). A ray from outside the infinite cylinder may hit the near side, or else the far side through an end or a
/// gap; a ray from inside hits the far side alone, for the near root is then negative or due to rounding.
template <class V, class Real, class Read>
ALHAZEN_HD ALHAZEN_NOINLINE CylinderLanes<V> intersect_lanes(const NumbersOf<CylinderRecord<Real>, Read>& cylinder,
                                                             const RayLanes<V>& ray) {
  const V zero = on_all_lanes<V>(Real(0)), one = on_all_lanes<V>(Real(1));
  const V from_centre[3] = {ray.origin[0] - cylinder[0], ray.origin[1] - cylinder[1], ray.origin[2] - cylinder[2]};
  const auto row = [&](int i, const V(&v)[3]) ALHAZEN_INLINE_LAMBDA {
    return cylinder[3 + 3 * i] * v[0] + cylinder[4 + 3 * i] * v[1] + cylinder[5 + 3 * i] * v[2];
  };
  CylinderLanes<V> hits;
  const V x = row(0, from_centre), y = row(1, from_centre), dx = row(0, ray.direction), dy = row(1, ray.direction);
  const V a = dx * dx + dy * dy;
  const V b = (zero - (x * dx + y * dy)) / a;
  const V closest_x = x + dx * b, closest_y = y + dy * b;
  const V discriminant = one - (closest_x * closest_x + closest_y * closest_y);
  hits.crossed = less_equal(zero, discriminant);
  if (hits.crossed == 0) return hits;
  const V root = square_root(discriminant / a);
  const V q = where_less(b, zero, b - root, b + root);
  const V c = x * x + y * y - one;
  const V other = c / (a * q);
  const V near = where_less(b, zero, q, other), far = where_less(b, zero, other, q);
  const V z = row(2, from_centre), dz = row(2, ray.direction);
  const V cosine = cylinder[12], sine = cylinder[13];
  // With the azimuth phi of the point in (-pi, pi], |phi| <= phi_max / 2 if sin(|phi| - phi_max / 2) <= 0.
  const auto is_on = [&](const V& t) ALHAZEN_INLINE_LAMBDA {
    return less_equal(magnitude(z + dz * t), one) & less_equal(magnitude(y + dy * t) * cosine, (x + dx * t) * sine);
  };
  const uint32_t near_hits = less(zero, c) & less(zero, near) & is_on(near);
  hits.crossed &= near_hits | is_on(far);
  hits.t = choose(near_hits, near, far);
  return hits;
}

template <class Real>
ALHAZEN_HD ALHAZEN_COLD bool intersect_record(const SceneView<Real>&, const CylinderRecord<Real>& record, PrimitiveId,
                                              const Ray<Real>& ray, const ShearedRay<Real>&, Real t_max,
                                              Hit<Real>& hit) {
  const auto number = [&](int k) { return record.number(k); };
  const RayLanes<Real> lane{
      {ray.origin.x, ray.origin.y, ray.origin.z}, {ray.direction.x, ray.direction.y, ray.direction.z}, ray.time};
  const CylinderLanes<Real> found = intersect_lanes(numbers_of<CylinderRecord<Real>>(number), lane);
  if (found.crossed == 0 || !(found.t > 0 && found.t <= t_max)) return false;
  hit.t = found.t;
  return true;
}

template <class Real>
ALHAZEN_HD Vec3<Real> object_from_world(const CylinderRecord<Real>& cylinder, const Vec3<Real>& from_centre) {
  const Vec3<Real>(&rows)[3] = cylinder.object_from_world;
  return {dot(rows[0], from_centre), dot(rows[1], from_centre), dot(rows[2], from_centre)};
}

template <class Real>
ALHAZEN_HD Vec3<Real> world_from_object(const CylinderRecord<Real>& cylinder, const Vec3<Real>& v) {
  const Vec3<Real>(&columns)[3] = cylinder.world_from_object;
  return columns[0] * v.x + columns[1] * v.y + columns[2] * v.z;
}

/// Bounds the error of a point of the cylinder, which is given in object space: that of its world position, and that of
/// the way back to object space in the intersection test. With m = |object_from_world| and w = |world_from_object|, the
/// test sees the coordinates of p to within 12 roundings of m w |p|. The scalar product of the normal with w (m w |p|)
/// is at least what m w |p| is radially, so a ray that starts by it off the surface is on the right side for the test.
template <class Real>
ALHAZEN_HD Vec3<Real> error_of_point(const CylinderRecord<Real>& cylinder, const Vec3<Real>& point) {
  const Vec3<Real>(&rows)[3] = cylinder.object_from_world;
  const Vec3<Real>(&columns)[3] = cylinder.world_from_object;
  const auto extent = [&](const Vec3<Real>& v) {
    return abs(columns[0]) * v.x + abs(columns[1]) * v.y + abs(columns[2]) * v.z;
  };
  const Vec3<Real> reach = extent(abs(point));
  const Vec3<Real> way_back{dot(abs(rows[0]), reach), dot(abs(rows[1]), reach), dot(abs(rows[2]), reach)};
  return (abs(cylinder.centre) + reach + extent(way_back)) * rounding_bound<Real>(12);
}

/// Returns the bounding box, padded by the error of its points.
template <class Real>
Bounds3<Real> bounds_of(const SceneView<Real>&, const CylinderRecord<Real>& cylinder) {
  const Vec3<Real>(&columns)[3] = cylinder.world_from_object;
  Vec3<Real> low, high;
  for (int axis = 0; axis < 3; ++axis) {
    // The arc is x cos(phi) + y sin(phi), which has its extremes at its ends, or where phi is that of (x, y) or
    // opposite.
    const Real x = columns[0][axis], y = columns[1][axis], half = cylinder.phi_max / 2;
    const Real middle = x * cylinder.cosine, side = std::abs(y * cylinder.sine);
    const Real radius = std::sqrt(x * x + y * y), phi = std::abs(std::atan2(y, x));
    high[axis] = phi <= half ? radius : middle + side;
    low[axis] = pi<Real> - phi <= half ? -radius : middle - side;
  }
  const Vec3<Real> pad = abs(columns[2]) + error_of_point(cylinder, splat(Real(1)));
  return {cylinder.centre + low - pad, cylinder.centre + high + pad};
}

/// Sets the interaction on a cylinder. The hit point is projected onto it, so its error does not depend on the length
/// of the ray.
template <class Real>
ALHAZEN_HD ALHAZEN_COLD void set_interaction(const SceneView<Real>& scene, const CylinderRecord<Real>& cylinder,
                                             const Ray<Real>& ray, const Hit<Real>& hit, SurfaceInteraction<Real>& si) {
  const Vec3<Real> hit_point = object_from_world(cylinder, ray.origin - cylinder.centre + ray.direction * hit.t);
  const Real inverse_radius = 1 / std::sqrt(hit_point.x * hit_point.x + hit_point.y * hit_point.y);
  const Vec3<Real> p{hit_point.x * inverse_radius, hit_point.y * inverse_radius, clamp(hit_point.z, Real(-1), Real(1))};
  si.position = cylinder.centre + world_from_object(cylinder, p);
  si.position_error = error_of_point(cylinder, p);
  const Vec3<Real> outward = normalize(cylinder.object_from_world[0] * p.x + cylinder.object_from_world[1] * p.y);
  si.normal = scene.surfaces[cylinder.surface].flip_normal ? -outward : outward;
  si.shading_normal = si.normal;
  const Real u = Real(0.5) + std::atan2(p.y, p.x) / cylinder.phi_max;
  si.uv = {clamp(u, Real(0), Real(1)), Real(0.5) * (p.z + 1)};
  si.surface = cylinder.surface;
}

/// Returns the tangents at the point with cosine x and sine y of the azimuth in object space.
template <class Real>
ALHAZEN_HD SurfaceTangents<Real> cylinder_tangents(const CylinderRecord<Real>& cylinder, Real x, Real y) {
  return {world_from_object(cylinder, {-y, x, Real(0)}) * cylinder.phi_max, cylinder.world_from_object[2] * Real(2)};
}

template <class Real>
ALHAZEN_HD SurfaceTangents<Real> tangents_of(const SceneView<Real>&, const CylinderRecord<Real>& cylinder,
                                             const Hit<Real>&, const SurfaceInteraction<Real>& si) {
  const Vec3<Real> p = object_from_world(cylinder, si.position - cylinder.centre);
  return cylinder_tangents(cylinder, p.x, p.y);
}

template <class Real>
ALHAZEN_HD Real uv_density_of(const SceneView<Real>&, const CylinderRecord<Real>& cylinder, const Hit<Real>&, Real,
                              const Vec3<Real>& normal, uint32_t) {
  // Normals in object space are those in world space times the transpose of world_from_object.
  const Real x = dot(cylinder.world_from_object[0], normal), y = dot(cylinder.world_from_object[1], normal);
  const SurfaceTangents<Real> tangents = cylinder_tangents(cylinder, x, y);
  return std::sqrt(x * x + y * y) / length(cross(tangents.dpdu, tangents.dpdv));
}

}  // namespace ALHAZEN_CORE

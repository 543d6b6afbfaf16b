#pragma once

// Cylinders without caps, whole or in part, under any affine map: intersection in object space, bounds, and the surface
// at a hit. The object space and the bound on errors are those of disks, too (disk.h).
//
// A cylinder and two disks may form a closed can, so no ray must pass between them. Both round their placement, and the
// tests round the coordinates of the ray in object space. A cylinder therefore reaches past its ends, and a disk past
// its radius, by a bound on both errors: that of a point there (`rim`), and that of the test, which grows with the
// distance along the ray (`rim_growth`). Inaccurate roots of the cylinder's equation need no more: they solve, for a
// radius that is a few roundings larger or smaller, the same equation, and the disk reaches past that, too. A ray that
// starts on one of them starts inside of the other, since hit points keep a distance from the rim (`rim_clearance`).

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
  const V from_anchor[3] = {ray.origin[0] - cylinder[0], ray.origin[1] - cylinder[1], ray.origin[2] - cylinder[2]};
  const auto row = [&](int i, const V(&v)[3]) ALHAZEN_INLINE_LAMBDA {
    return cylinder[3 + 3 * i] * v[0] + cylinder[4 + 3 * i] * v[1] + cylinder[5 + 3 * i] * v[2];
  };
  CylinderLanes<V> hits;
  const V x = row(0, from_anchor), y = row(1, from_anchor), dx = row(0, ray.direction), dy = row(1, ray.direction);
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
  const V z = row(2, from_anchor) + cylinder[16], dz = row(2, ray.direction);
  const V cosine = cylinder[12], sine = cylinder[13], rim = cylinder[14], rim_growth = cylinder[15];
  // With the azimuth phi of the point in (-pi, pi], |phi| <= phi_max / 2 if sin(|phi| - phi_max / 2) <= 0.
  const auto is_on = [&](const V& t) ALHAZEN_INLINE_LAMBDA {
    return less(magnitude(z + dz * t), rim + rim_growth * t) &
           less_equal(magnitude(y + dy * t) * cosine, (x + dx * t) * sine);
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

/// Returns a vector of world space in object space.
template <class Real>
ALHAZEN_HD Vec3<Real> object_from_world(const QuadricRecord<Real>& quadric, const Vec3<Real>& v) {
  const Vec3<Real>(&rows)[3] = quadric.object_from_world;
  return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)};
}

/// Returns the point of object space at a vector from the anchor in world space.
template <class Real>
ALHAZEN_HD Vec3<Real> object_point(const QuadricRecord<Real>& quadric, const Vec3<Real>& from_anchor) {
  return object_from_world(quadric, from_anchor) + Vec3<Real>{0, 0, quadric.anchor_z};
}

/// Returns a vector of object space in world space.
template <class Real>
ALHAZEN_HD Vec3<Real> world_from_object(const QuadricRecord<Real>& quadric, const Vec3<Real>& v) {
  const Vec3<Real>(&columns)[3] = quadric.world_from_object;
  return columns[0] * v.x + columns[1] * v.y + columns[2] * v.z;
}

/// Returns the vector from the anchor to a point, both in object space.
template <class Real>
ALHAZEN_HD Vec3<Real> from_anchor(const QuadricRecord<Real>& quadric, const Vec3<Real>& point) {
  return {point.x, point.y, point.z - quadric.anchor_z};
}

template <class Real>
ALHAZEN_HD Vec3<Real> world_point(const QuadricRecord<Real>& quadric, const Vec3<Real>& point) {
  return quadric.anchor + world_from_object(quadric, from_anchor(quadric, point));
}

/// Bounds the error of a point of the cylinder or disk, which is given in object space: that of its world position, and
/// that of the way back to object space in the intersection test. With m = |object_from_world|, w = |world_from_object|
/// and p the vector from the anchor, the test sees the coordinates of p to within 12 roundings of m w |p|. The scalar
/// product of the normal with w (m w |p|) is at least what m w |p| is along the normal in object space, so a ray that
/// starts by it off the surface is on the right side for the test.
template <class Real>
ALHAZEN_HD Vec3<Real> error_of_point(const QuadricRecord<Real>& quadric, const Vec3<Real>& point) {
  const Vec3<Real>(&rows)[3] = quadric.object_from_world;
  const Vec3<Real>(&columns)[3] = quadric.world_from_object;
  const auto extent = [&](const Vec3<Real>& v) {
    return abs(columns[0]) * v.x + abs(columns[1]) * v.y + abs(columns[2]) * v.z;
  };
  const Vec3<Real> reach = extent(abs(from_anchor(quadric, point)));
  const Vec3<Real> way_back{dot(abs(rows[0]), reach), dot(abs(rows[1]), reach), dot(abs(rows[2]), reach)};
  return (abs(quadric.anchor) + reach + extent(way_back)) * rounding_bound<Real>(12);
}

/// Distance in object space that hit points keep from the rim. It is some errors of a point, so that a ray which starts
/// there, moved off the surface, is on the inner side of a shape that shares the rim, for the test of that shape.
template <class Real>
ALHAZEN_HD Real rim_clearance(const QuadricRecord<Real>& quadric) {
  return 4 * (quadric.rim - 1);
}

/// Returns the box of the arc with radius 1 in the plane z = 0, as offsets from its centre in world space.
template <class Real>
Bounds3<Real> bounds_of_arc(const QuadricRecord<Real>& quadric) {
  Bounds3<Real> box;
  for (int axis = 0; axis < 3; ++axis) {
    // The arc is x cos(phi) + y sin(phi), which has its extremes at its ends, or where phi is that of (x, y) or
    // opposite.
    const Real x = quadric.world_from_object[0][axis], y = quadric.world_from_object[1][axis];
    const Real middle = x * quadric.cosine, side = std::abs(y * quadric.sine);
    const Real radius = std::sqrt(x * x + y * y), phi = std::abs(std::atan2(y, x)), half = quadric.phi_max / 2;
    box.high[axis] = phi <= half ? radius : middle + side;
    box.low[axis] = pi<Real> - phi <= half ? -radius : middle - side;
  }
  return box;
}

/// Returns the bounding box, padded by the error of its points.
template <class Real>
Bounds3<Real> bounds_of(const SceneView<Real>&, const CylinderRecord<Real>& cylinder) {
  const Bounds3<Real> arc = bounds_of_arc(cylinder);
  const Vec3<Real> centre = world_point(cylinder, {});
  const Vec3<Real> far_end{1, 1, -cylinder.anchor_z};
  const Vec3<Real> pad = abs(cylinder.world_from_object[2]) * cylinder.rim + error_of_point(cylinder, far_end);
  return {centre + arc.low - pad, centre + arc.high + pad};
}

/// Sets the interaction on a cylinder. The hit point is projected onto it, so its error does not depend on the length
/// of the ray, and moved away from the ends.
template <class Real>
ALHAZEN_HD ALHAZEN_COLD void set_interaction(const SceneView<Real>& scene, const CylinderRecord<Real>& cylinder,
                                             const Ray<Real>& ray, const Hit<Real>& hit, SurfaceInteraction<Real>& si) {
  const Vec3<Real> hit_point = object_point(cylinder, ray.origin - cylinder.anchor + ray.direction * hit.t);
  const Real inverse_radius = 1 / std::sqrt(hit_point.x * hit_point.x + hit_point.y * hit_point.y);
  const Real end = max(1 - rim_clearance(cylinder), Real(0));
  const Vec3<Real> p{hit_point.x * inverse_radius, hit_point.y * inverse_radius, clamp(hit_point.z, -end, end)};
  si.position = world_point(cylinder, p);
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
  const Vec3<Real> p = object_point(cylinder, si.position - cylinder.anchor);
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

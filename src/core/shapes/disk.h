#pragma once

// Disks, whole or in part, with or without a hole, under any affine map: intersection in object space, bounds, and the
// surface at a hit. cylinder.h has what they share with cylinders, and says how far they reach past their radius.

#include "core/shapes/cylinder.h"

namespace ALHAZEN_CORE {

/// Hits of disks, one per lane, or one alone.
template <class V>
struct DiskLanes {
  V t;
  uint32_t crossed = 0;  ///< one bit per lane whose disk is hit

  template <class Real>
  ALHAZEN_INLINE void fill(int, Hit<Real>& hit) const {
    hit.b1 = hit.b2 = 0;
  }
};

/// Intersects rays with disks, in object space. A ray in the plane of a disk does not hit it.
template <class V, class Real, class Read>
ALHAZEN_HD ALHAZEN_NOINLINE DiskLanes<V> intersect_lanes(const NumbersOf<DiskRecord<Real>, Read>& disk,
                                                         const RayLanes<V>& ray) {
  const V zero = on_all_lanes<V>(Real(0));
  const V from_centre[3] = {ray.origin[0] - disk[0], ray.origin[1] - disk[1], ray.origin[2] - disk[2]};
  const auto row = [&](int i, const V(&v)[3]) ALHAZEN_INLINE_LAMBDA {
    return disk[3 + 3 * i] * v[0] + disk[4 + 3 * i] * v[1] + disk[5 + 3 * i] * v[2];
  };
  DiskLanes<V> hits;
  hits.t = (zero - row(2, from_centre)) / row(2, ray.direction);
  const V x = row(0, from_centre) + row(0, ray.direction) * hits.t;
  const V y = row(1, from_centre) + row(1, ray.direction) * hits.t;
  const V radius_squared = x * x + y * y;
  const V growth = disk[15] * hits.t, rim = disk[14] + growth, inner_rim = disk[16] - growth;
  // The inner rim may be below zero, where everything is outside of it. At an infinite t, infinity is not below itself.
  hits.crossed = less(zero, hits.t) & less(radius_squared, rim * rim) &
                 less_equal(inner_rim * magnitude(inner_rim), radius_squared) &
                 less_equal(magnitude(y) * disk[12], x * disk[13]);  // |phi| <= phi_max / 2, as for cylinders
  return hits;
}

template <class Real>
ALHAZEN_HD ALHAZEN_COLD bool intersect_record(const SceneView<Real>&, const DiskRecord<Real>& record, PrimitiveId,
                                              const Ray<Real>& ray, const ShearedRay<Real>&, Real t_max,
                                              Hit<Real>& hit) {
  const auto number = [&](int k) { return record.number(k); };
  const RayLanes<Real> lane{
      {ray.origin.x, ray.origin.y, ray.origin.z}, {ray.direction.x, ray.direction.y, ray.direction.z}, ray.time};
  const DiskLanes<Real> found = intersect_lanes(numbers_of<DiskRecord<Real>>(number), lane);
  if (found.crossed == 0 || !(found.t <= t_max)) return false;
  hit.t = found.t;
  return true;
}

/// Returns the bounding box, padded by the error of its points.
template <class Real>
Bounds3<Real> bounds_of(const SceneView<Real>&, const DiskRecord<Real>& disk) {
  Bounds3<Real> arc = bounds_of_arc(disk);
  arc.extend(Vec3<Real>{});
  const Vec3<Real> pad = error_of_point(disk, {1, 1, 0});
  return {disk.anchor + arc.low * disk.rim - pad, disk.anchor + arc.high * disk.rim + pad};
}

/// Sets the interaction on a disk. The hit point is projected onto it, so its error does not depend on the length of
/// the ray, and moved away from the rims.
template <class Real>
ALHAZEN_HD ALHAZEN_COLD void set_interaction(const SceneView<Real>& scene, const DiskRecord<Real>& disk,
                                             const Ray<Real>& ray, const Hit<Real>& hit, SurfaceInteraction<Real>& si) {
  const Vec3<Real> hit_point = object_point(disk, ray.origin - disk.anchor + ray.direction * hit.t);
  const Real radius = std::sqrt(hit_point.x * hit_point.x + hit_point.y * hit_point.y), inner = disk.inner_radius;
  const Real clearance = min(rim_clearance(disk), (1 - inner) / 2);
  const Real moved = clamp(radius, inner > 0 ? inner + clearance : Real(0), 1 - clearance);
  const Real scale = radius > 0 ? moved / radius : Real(0);
  const Vec3<Real> p{hit_point.x * scale, hit_point.y * scale, 0};
  si.position = world_point(disk, p);
  // An axis-aligned disk has no error across its plane. With a little, rays start out of the plane, where other
  // surfaces may be.
  const Vec3<Real> extent = abs(disk.world_from_object[0]) + abs(disk.world_from_object[1]);
  si.position_error = error_of_point(disk, p) + splat(max_component(extent) * rounding_bound<Real>(1));
  const Vec3<Real> upward = normalize(disk.object_from_world[2]);
  si.normal = scene.surfaces[disk.surface].flip_normal ? -upward : upward;
  si.shading_normal = si.normal;
  const Real u = Real(0.5) + std::atan2(p.y, p.x) / disk.phi_max;
  si.uv = {clamp(u, Real(0), Real(1)), clamp((1 - radius) / (1 - inner), Real(0), Real(1))};
  si.surface = disk.surface;
}

template <class Real>
ALHAZEN_HD SurfaceTangents<Real> tangents_of(const SceneView<Real>&, const DiskRecord<Real>& disk, const Hit<Real>&,
                                             const SurfaceInteraction<Real>& si) {
  const Vec3<Real> p = object_point(disk, si.position - disk.anchor);
  const Real radius = std::sqrt(p.x * p.x + p.y * p.y);
  if (!(radius > 0)) return {};
  const Real inward = (disk.inner_radius - 1) / radius;
  return {world_from_object(disk, {-p.y, p.x, Real(0)}) * disk.phi_max,
          world_from_object(disk, {p.x * inward, p.y * inward, Real(0)})};
}

/// The mean over the disk: the density itself has no bound at the centre.
template <class Real>
ALHAZEN_HD Real uv_density_of(const SceneView<Real>&, const DiskRecord<Real>& disk, const Hit<Real>&, Real,
                              const Vec3<Real>&, uint32_t) {
  const Real unit_area = length(cross(disk.world_from_object[0], disk.world_from_object[1]));
  return 1 / (disk.phi_max / 2 * (1 - disk.inner_radius * disk.inner_radius) * unit_area);
}

}  // namespace ALHAZEN_CORE

#pragma once

// The report's Algorithm 3: recursion that follows one branch, chosen at random at a dielectric.

#include "core/integrators/stages.h"

namespace ALHAZEN_CORE {

/// Radiance that arrives along `ray` over at most `segments_left` segments; `segment` counts those before it.
template <class Real, RayIntersector<Real> Intersector, SamplerOf<Real> Sampler>
ALHAZEN_HD Vec3<Real> cast_ray_recursive(const SceneView<Real>& scene, const Intersector& intersector,
                                         const Sampler& sampler, Ray<Real> ray, uint32_t segments_left,
                                         uint32_t segment, SampleRecord<Real>& record) {
  if (segments_left == 0) return {};
  ++record.segments;
  Hit<Real> hit;
  Real travelled = 0;
  if (!closest_stop(scene, intersector, ray_kind(segment), ray, hit, travelled))
    return escape(scene, ray.direction, segment, record);
  const ShadingPoint<Real> point = shading_point(scene, ray, hit);
  if (segment == 0) record_first_hit(point, travelled + hit.t, record);
  if (segment == 0) record_first_point(scene, point, record);
  const Vec3<Real> transmittance = beer_lambert(point, travelled + hit.t);
  const Vec3<Real> emission = transmittance * surface_emission(scene, hit, point);
  const BsdfSample<Real> s = scatter(point, sampler, VertexDimensions(segment));
  if (!(s.pdf > 0) || is_zero(s.weight)) return emission;
  return emission + transmittance * s.weight *
                        cast_ray_recursive(scene, intersector, sampler, spawn_ray(point.si, s.direction),
                                           segments_left - 1, segment + 1, record);
}

}  // namespace ALHAZEN_CORE

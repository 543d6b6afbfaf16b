#pragma once

// The report's Algorithm 2: recursion that follows both reflection and refraction at a smooth dielectric. The cost
// grows as 2^D through glass.

#include "core/integrators/stages.h"

namespace ALHAZEN_CORE {

/// Radiance that arrives along `ray` over at most `segments_left` segments; `segment` counts those before it.
template <class Real, RayIntersector<Real> Intersector, ForkingSampler<Real> Sampler>
ALHAZEN_HD Vec3<Real> cast_ray_branching(const SceneView<Real>& scene, const Intersector& intersector,
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
  Vec3<Real> radiance = transmittance * surface_emission(scene, hit, point);
  const VertexDimensions dimensions(segment);

  const auto follow = [&](const BsdfSample<Real>& s, const Sampler& numbers, Real rate) {
    if (!(s.pdf > 0 && rate > 0) || is_zero(s.weight) || !is_on_one_side(point, s.direction)) return;
    radiance += transmittance * s.weight * rate *
                cast_ray_branching(scene, intersector, numbers, spawn_ray(point.si, s.direction), segments_left - 1,
                                   segment + 1, record);
  };
  if (point.bsdf.kind != MaterialKind::dielectric || !point.bsdf.is_specular()) {
    follow(scatter(point, sampler, dimensions), sampler, Real(1));
    return radiance;
  }
  const Frame<Real>& frame = point.bsdf.frame;
  DielectricBranches<Real> branches = dielectric_branches(point.bsdf.dielectric, frame.to_local(point.wo),
                                                          sampler.template get_2d<Real>(dimensions.bsdf_direction()));
  branches.reflected.direction = frame.to_world(branches.reflected.direction);
  branches.refracted.direction = frame.to_world(branches.refracted.direction);
  follow(branches.reflected, sampler.fork(0), branches.reflected_rate);
  follow(branches.refracted, sampler.fork(1), 1 - branches.reflected_rate);
  return radiance;
}

}  // namespace ALHAZEN_CORE

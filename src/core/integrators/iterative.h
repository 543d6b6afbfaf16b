#pragma once

// The report's Algorithm 5: one branch at a time in a loop, emission found by chance. Unlike the report's listing, a
// ray that leaves the scene keeps the emission gathered before it.

#include "core/integrators/stages.h"

namespace alhazen {

template <class Real, class Intersector, class Sampler>
ALHAZEN_HD void iterative_radiance(const SceneView<Real>& scene, const Intersector& intersector, const Sampler& sampler,
                                   Ray<Real> ray, uint32_t max_segments, SampleRecord<Real>& record) {
  Vec3<Real> attenuation = splat(Real(1));
  for (uint32_t segment = 0; segment < max_segments; ++segment) {
    ++record.segments;
    Hit<Real> hit;
    if (!intersector.closest_hit(ray, infinity<Real>, hit)) {
      record.radiance += attenuation * scene.background;
      return;
    }
    const ShadingPoint<Real> point = shading_point(scene, ray, hit);
    if (segment == 0) record_first_hit(point, hit, record);
    record.radiance += attenuation * surface_emission(scene, point);
    const BsdfSample<Real> s = scatter(point, sampler, VertexDimensions(segment));
    if (!(s.pdf > 0) || is_zero(s.weight)) return;
    attenuation *= s.weight;
    ray = spawn_ray(point.si, s.direction);
  }
}

}  // namespace alhazen

#pragma once

// The report's Algorithm 5: one branch at a time in a loop, emission found by chance. Unlike the report's listing, a
// ray that leaves the scene keeps the emission gathered before it.

#include "core/integrators/stages.h"

namespace ALHAZEN_CORE {

/// A path under way, between two segments.
template <class Real>
struct IterativeState {
  Ray<Real> ray;
  Vec3<Real> throughput = splat(Real(1));
  uint32_t vertex = 0;  ///< how many surfaces it met so far
  Real travelled = 0;   ///< how far it came before the ray's origin, through surfaces that let it pass
};

template <class Real, class Record>
ALHAZEN_HD ALHAZEN_HOT void leave_scene(const SceneView<Real>& scene, const IterativeState<Real>& path,
                                        Record& record) {
  record.radiance += path.throughput * background_radiance(scene, path.ray.direction);
}

/// Gathers and scatters where the path met a surface. False when it ends there.
template <class Real, class Sampler, class Record>
ALHAZEN_HD ALHAZEN_HOT bool shade_at(const SceneView<Real>& scene, const Sampler& sampler, uint32_t max_segments,
                                     const Hit<Real>& hit, const ShadingPoint<Real>& point, IterativeState<Real>& path,
                                     Record& record) {
  path.throughput *= arriving_share(point, path.travelled + hit.t);
  if (path.vertex == 0) record_first_hit(point, path.travelled + hit.t, record);
  record.radiance += path.throughput * surface_emission(scene, hit, point);
  if (path.vertex + 1 >= max_segments) return false;
  const BsdfSample<Real> s = scatter(point, sampler, VertexDimensions(path.vertex));
  if (!(s.pdf > 0) || is_zero(s.weight)) return false;
  path.throughput *= s.weight;
  path.ray = spawn_ray(point.si, s.direction);
  path.travelled = 0;
  ++path.vertex;
  return true;
}

/// The same from the hit on. `light` is not asked for any.
template <class Real, class Sampler, class Record, class Light>
ALHAZEN_HD ALHAZEN_INLINE bool shade(const SceneView<Real>& scene, const Sampler& sampler, uint32_t max_segments,
                                     const Hit<Real>& hit, IterativeState<Real>& path, Record& record, const Light&) {
  if (scene.has_cutouts && passes(scene, hit, ray_kind(path.vertex), path.ray, path.travelled))
    return record.segments < most_passages;
  return shade_at(scene, sampler, max_segments, hit, shading_point(scene, path.ray, hit), path, record);
}

}  // namespace ALHAZEN_CORE

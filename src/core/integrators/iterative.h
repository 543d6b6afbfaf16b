#pragma once

// The report's Algorithm 5: a loop that follows one branch, with emission found by BSDF sampling alone. Unlike in the
// report's listing, a ray that escapes keeps the emission gathered before it.

#include "core/integrators/stages.h"

namespace ALHAZEN_CORE {

/// The state of a path between two segments.
template <class Real>
struct IterativeState {
  Ray<Real> ray;
  Vec3<Real> throughput = splat(Real(1));
  uint32_t vertex = 0;  ///< number of surfaces hit so far
  Real travelled = 0;   ///< distance before the ray's origin, through surfaces that the ray passed through

  using Fields =
      FieldList<&IterativeState::ray, &IterativeState::throughput, &IterativeState::vertex, &IterativeState::travelled>;
};

template <class Real, class Record>
ALHAZEN_HD ALHAZEN_HOT void add_infinite_lights(const SceneView<Real>& scene, const IterativeState<Real>& path,
                                                Record& record) {
  if (path.vertex == 0) record.transparency = 1;
  if (path.vertex == 0 && scene.hides_background) return;
  record.radiance += path.throughput * background_radiance(scene, path.ray.direction);
}

/// Adds emission and scatters at a hit. Returns false when the path ends.
template <class Real, SamplerOf<Real> Sampler, RecordOf<Real> Record>
ALHAZEN_HD ALHAZEN_HOT bool shade_at(const SceneView<Real>& scene, const Sampler& sampler, uint32_t max_segments,
                                     const Hit<Real>& hit, const ShadingPoint<Real>& point, IterativeState<Real>& path,
                                     Record& record) {
  path.throughput *= beer_lambert(point, path.travelled + hit.t);
  if (path.vertex == 0) record_first_hit(point, path.travelled + hit.t, record);
  if (path.vertex == 0) record_first_point(scene, point, record);
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

/// The same with the shading point given. `light` and the trail are not used.
template <class Real, SamplerOf<Real> Sampler, RecordOf<Real> Record, ShadowRayReceiver<Real> Light, class Trail>
ALHAZEN_HD ALHAZEN_INLINE bool shade(const SceneView<Real>& scene, const Sampler& sampler, uint32_t max_segments,
                                     const Hit<Real>& hit, IterativeState<Real>& path, Record& record, const Light&,
                                     Trail&) {
  if (scene.has_cutouts && passes(scene, hit, ray_kind(path.vertex), path.ray, path.travelled))
    return record.segments < max_transparent_hits;
  return shade_at(scene, sampler, max_segments, hit, shading_point(scene, path.ray, hit), path, record);
}

}  // namespace ALHAZEN_CORE

#pragma once

// Takes one sample of one pixel: generates a camera ray and runs the selected integrator.

#include <type_traits>

#include "core/integrators/branching.h"
#include "core/integrators/guided.h"
#include "core/integrators/integrator_kind.h"
#include "core/integrators/iterative.h"
#include "core/integrators/recursive.h"
#include "core/math/field_list.h"

namespace ALHAZEN_CORE {

template <class Real>
struct CameraSample {
  Ray<Real> ray;
  Real filter_weight;
};

/// Film position of a sample of pixel (x, y), in pixels, and its filter weight.
template <class Real>
struct FilmSample {
  Vec2<Real> position;
  Real filter_weight;

  using Fields = FieldList<&FilmSample::position, &FilmSample::filter_weight>;
};

template <class Real>
ALHAZEN_HD ALHAZEN_HOT FilmSample<Real> film_sample(uint32_t x, uint32_t y, const FilterSample<Real>& filter) {
  return {{static_cast<Real>(x) + Real(0.5) + filter.offset.x, static_cast<Real>(y) + Real(0.5) + filter.offset.y},
          filter.weight};
}

template <class Real, SamplerOf<Real> Sampler>
ALHAZEN_HD ALHAZEN_HOT CameraSample<Real> sample_camera(const SceneView<Real>& scene, const Sampler& sampler,
                                                        uint32_t x, uint32_t y) {
  const FilmSample<Real> film = film_sample(
      x, y, sample_filter(scene.filter, scene.filter_cdf, sampler.template get_2d<Real>(CameraDimensions::film)));
  const Vec2<Real> lens =
      scene.camera.lens_radius > 0 ? sampler.template get_2d<Real>(CameraDimensions::lens) : Vec2<Real>{};
  const Real time = scene_moves(scene) ? sampler.template get_1d<Real>(CameraDimensions::time) : Real(0);
  return {camera_ray(scene.camera, film.position, lens, time), film.filter_weight};
}

/// The state of an iterative integrator between two segments.
template <IntegratorKind kind, class Real>
using StateOf = std::conditional_t<samples_lights(kind), PathState<Real>, IterativeState<Real>>;

/// Traces one segment of a path: intersects, adds emission and direct light, scatters. Returns false when the path has
/// ended.
template <class Real, RayIntersector<Real> Intersector, SamplerOf<Real> Sampler, class State, RecordOf<Real> Record,
          class Trail>
ALHAZEN_HD bool take_segment(const SceneView<Real>& scene, const Intersector& intersector, const Sampler& sampler,
                             uint32_t max_segments, State& path, Record& record, Trail& trail) {
  ++record.segments;
  trail.start_segment(luminance(record.radiance));
  Hit<Real> hit;
  if (!intersector.closest_hit(path.ray, infinity<Real>, hit)) {
    add_infinite_lights(scene, path, record);
    return false;
  }
  return shade(
      scene, sampler, max_segments, hit, path, record,
      [&](const ShadowRay<Real>& shadow, const Vec3<Real>& radiance) {
        const Real visibility = visibility_of(scene, intersector, shadow);
        if (visibility > 0) record.add_sampled(limited(scene, radiance, path.vertex >= 1) * visibility);
        if constexpr (has_counters<Record>)
          if (!(visibility > 0)) record.counters.count_blocked();
      },
      trail);
}

/// Radiance along `ray` by the integrator `kind`, over at most `max_segments` >= 1 segments.
template <IntegratorKind kind, class Real, RayIntersector<Real> Intersector, SamplerOf<Real> Sampler>
ALHAZEN_HD SampleRecord<Real> integrate(const SceneView<Real>& scene, const Intersector& intersector,
                                        const Sampler& sampler, const Ray<Real>& ray, uint32_t max_segments,
                                        const WantedRecords& wanted = {}, PartedLight<Real>* parts = nullptr) {
  SampleRecord<Real> record;
  record.wanted = wanted;
  record.parts = parts;
  if constexpr (samples_lights(kind) || kind == IntegratorKind::iterative) {
    StateOf<kind, Real> path;
    path.ray = ray;
    TrailOf<kind, Real> trail;
    while (take_segment(scene, intersector, sampler, max_segments, path, record, trail)) {
    }
    learn_from_path(scene, trail, record.radiance);
  } else if constexpr (kind == IntegratorKind::recursive) {
    record.radiance = cast_ray_recursive(scene, intersector, sampler, ray, max_segments, 0, record);
  } else {
    record.radiance = cast_ray_branching(scene, intersector, sampler, ray, max_segments, 0, record);
  }
  record.expose(scene.exposure);
  return record;
}

}  // namespace ALHAZEN_CORE

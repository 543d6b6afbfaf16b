#pragma once

// Many paths at a time on one core: the rays of all that are under way are traced together, so that the intersector can
// walk them in turns, and then each path is shaded. A path that ends makes room for the next sample. What a path does
// is what `integrate` does, in the same order, to the same bits.

#include "core/integrators/camera_sample.h"

namespace ALHAZEN_CORE {

/// How many paths are under way. Their state stays in the second level cache.
inline constexpr uint32_t batch_lanes = 128;

/// A path under way, and the light that it waits for.
template <IntegratorKind kind, class Real, class Sampler>
struct BatchLane {
  Sampler sampler{0, 0, 0, 0};
  StateOf<kind, Real> path;
  SampleRecord<Real> record;
  Hit<Real> hit;
  bool has_met = false;
  uint32_t sample;  ///< which of the batch
  ShadowRay<Real> shadow;
  Vec3<Real> lit;  ///< what the path gains where the shadow ray is free
};

/// Takes `count` samples: `begin(i, sampler)` sets the sampler of sample i and returns its camera ray, `end(i, record)`
/// is called once for each, in any order. Records keep the first hit where that is wanted.
template <IntegratorKind kind, class Sampler, class Real, class Intersector, class Begin, class End>
void integrate_batch(const SceneView<Real>& scene, const Intersector& intersector, uint32_t max_segments,
                     bool wants_first_hit, uint32_t count, const Begin& begin, const End& end) {
  using Lane = BatchLane<kind, Real, Sampler>;
  Lane lanes[batch_lanes];
  uint32_t active[batch_lanes], lit[batch_lanes];
  uint32_t next = 0, live = 0;
  const auto start = [&](Lane& lane) {
    lane.sample = next++;
    lane.path = {};
    lane.record = {};
    lane.record.keeps_first_hit = wants_first_hit;
    lane.path.ray = begin(lane.sample, lane.sampler);
  };
  for (; live < batch_lanes && next < count; ++live) {
    start(lanes[live]);
    active[live] = live;
  }
  while (live > 0) {
    intersector.template trace<false>(
        live, [&](uint32_t i) -> const Ray<Real>& { return lanes[active[i]].path.ray; },
        [](uint32_t) { return infinity<Real>; },
        [&](uint32_t i, bool found, const Hit<Real>& hit) {
          lanes[active[i]].hit = hit;
          lanes[active[i]].has_met = found;
        });
    uint32_t lit_count = 0, ended_count = 0, live_on = 0;
    uint32_t ended[batch_lanes];
    for (uint32_t i = 0; i < live; ++i) {
      const uint32_t index = active[i];
      Lane& lane = lanes[index];
      ++lane.record.segments;
      bool goes_on = false;
      if (lane.has_met)
        goes_on = shade(scene, lane.sampler, max_segments, lane.hit, lane.path, lane.record,
                        [&](const ShadowRay<Real>& shadow, const Vec3<Real>& radiance) {
                          lane.shadow = shadow;
                          lane.lit = radiance;
                          lit[lit_count++] = index;
                        });
      else
        leave_scene(scene, lane.path, lane.record);
      if (goes_on)
        active[live_on++] = index;
      else
        ended[ended_count++] = index;
    }
    intersector.template trace<true>(
        lit_count, [&](uint32_t i) -> const Ray<Real>& { return lanes[lit[i]].shadow.ray; },
        [&](uint32_t i) { return lanes[lit[i]].shadow.t_max; },
        [&](uint32_t i, bool found, const Hit<Real>&) {
          if (!found) lanes[lit[i]].record.radiance += lanes[lit[i]].lit;
        });
    for (uint32_t i = 0; i < ended_count; ++i) {
      Lane& lane = lanes[ended[i]];
      lane.record.radiance *= scene.exposure;
      end(lane.sample, lane.record);
      if (next == count) continue;
      start(lane);
      active[live_on++] = ended[i];
    }
    live = live_on;
  }
}

}  // namespace ALHAZEN_CORE

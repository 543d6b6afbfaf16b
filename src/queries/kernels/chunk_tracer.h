#pragma once

// Traces some rays by the fastest way for each: coherent ones in packets, all others together.

#include "core/bvh/bvh8/intersector.h"
#include "core/math/ray.h"
#include "core/shapes/interaction.h"

namespace ALHAZEN_CORE {

/// Rays as the core traces them, some of a request's.
template <class Real>
struct PreparedRays {
  /// The rays and their hits stay in the second-level cache.
  static constexpr uint32_t capacity = 1024;

  uint32_t count = 0;
  Ray<Real> rays[capacity];
  Real limit[capacity];  ///< in units of world space; 0 for rays that hit nothing
  Real origin[3][capacity], direction[3][capacity], time[capacity];

  /// Returns whether the rays of a packet, of which the first is `first`, start within about `max_spread` of each other
  /// in directions close to each other, so that most of them visit the same nodes.
  ALHAZEN_INLINE bool is_coherent(uint32_t first, Real max_spread) const {
    using V = Lanes<Real, RayPacket<Real>::width>;
    constexpr Real max_direction_spread = Real(0.125);
    const auto is_within = [&](const Real* row, Real spread) {
      return less(V::all(spread), magnitude(V::load(row + first) - V::all(row[first]))) == 0;
    };
    return is_within(direction[0], max_direction_spread) && is_within(direction[1], max_direction_spread) &&
           is_within(direction[2], max_direction_spread) && is_within(origin[0], max_spread) &&
           is_within(origin[1], max_spread) && is_within(origin[2], max_spread);
  }
};

/// What they hit.
template <class Real>
struct ChunkHits {
  Hit<Real> hit[PreparedRays<Real>::capacity];
  bool found[PreparedRays<Real>::capacity];
};

template <class Real>
class ChunkTracer {
 public:
  using Rays = PreparedRays<Real>;

  /// Few primitives are tested faster by brute force, which any rays may share.
  explicit ChunkTracer(const SceneView<Real>& scene)
      : scene_(&scene),
        intersector_(scene),
        uses_packets_(scene.instances_count == 0 && !BruteForcePackets<Real>(scene).is_worthwhile()),
        max_spread_(max_component(scene.bounds.high - scene.bounds.low) * Real(1.0 / 128)) {}

  /// `prefetches` the records of the primitives that are hit.
  ALHAZEN_NOINLINE void closest_hits(const Rays& rays, bool prefetches, ChunkHits<Real>& hits) {
    const auto answer = [&](uint32_t i, bool found, const Hit<Real>& hit) {
      hits.hit[i] = hit;
      hits.found[i] = found;
      if (found && prefetches) prefetch_primitive(*scene_, hit.primitive);
    };
    constexpr uint32_t width = RayPacket<Real>::width;
    uint32_t run = 0, others = 0;  // the coherent rays before `first` start at `run`
    for (uint32_t first = 0; first < rays.count; first += width) {
      const uint32_t size = min(width, rays.count - first);
      if (uses_packets_ && size == width && rays.is_coherent(first, max_spread_)) continue;
      trace_packets(rays, run, first - run, answer);
      for (uint32_t i = 0; i < size; ++i) others_[others++] = first + i;
      run = first + size;
    }
    trace_packets(rays, run, rays.count - run, answer);
    intersector_.template trace<false>(
        others, [&](uint32_t i) -> const Ray<Real>& { return rays.rays[others_[i]]; },
        [&](uint32_t i) { return rays.limit[others_[i]]; },
        [&](uint32_t i, bool found, const Hit<Real>& hit) { answer(others_[i], found, hit); });
  }

  ALHAZEN_NOINLINE void occluded(const Rays& rays, uint8_t* to) const {
    intersector_.template trace<true>(
        rays.count, [&](uint32_t i) -> const Ray<Real>& { return rays.rays[i]; },
        [&](uint32_t i) { return rays.limit[i]; },
        [&](uint32_t i, bool found, const Hit<Real>&) { to[i] = found ? 1 : 0; });
  }

 private:
  template <HitReceiver<Real> Answer>
  ALHAZEN_NOINLINE void trace_packets(const Rays& rays, uint32_t first, uint32_t count, const Answer& answer) const {
    if (count == 0) return;
    intersector_.trace_coherent(
        count, [&](uint32_t i) -> const Ray<Real>& { return rays.rays[first + i]; },
        [&](uint32_t i) { return rays.limit[first + i]; },
        [&](uint32_t i, bool found, const Hit<Real>& hit) { answer(first + i, found, hit); });
  }

  const SceneView<Real>* scene_;
  Bvh8Intersector<Real> intersector_;
  bool uses_packets_;
  Real max_spread_;  ///< of the origins of coherent rays
  uint32_t others_[Rays::capacity];
};

}  // namespace ALHAZEN_CORE

#pragma once

// Traces some rays by the fastest way for each: coherent ones in packets, all others together.

#include "core/bvh/bvh8/intersector.h"
#include "core/math/ray.h"
#include "queries/kernels/hit_rows.h"

namespace ALHAZEN_CORE {

/// Vectors of a caller that are read later.
class LaterVectors {
 public:
  LaterVectors() = default;
  template <class Number>
  LaterVectors(const Number* array, std::ptrdiff_t stride, size_t first)
      : step_(static_cast<uintptr_t>(stride) * sizeof(Number)),
        first_(reinterpret_cast<uintptr_t>(array) + first * step_) {}

  /// Prefetches vector i; there need not be one.
  ALHAZEN_INLINE void prefetch(uint32_t i) const {
    __builtin_prefetch(reinterpret_cast<const void*>(first_ + i * step_));
  }

 private:
  uintptr_t step_ = 0, first_ = 0;
};

/// Rays as the core traces them, some of a request's.
template <class Real>
struct PreparedRays {
  /// The rays and their hits take about the first-level cache, and interleaving rarely runs out of rays.
  static constexpr uint32_t capacity = 512;
  static constexpr uint32_t packet = RayPacket<Real>::width;

  uint32_t count = 0;
  Ray<Real> rays[capacity];
  Real limit[capacity];                 ///< in units of world space; 0 for rays that hit nothing
  bool is_coherent[capacity / packet];  ///< of the whole packets: most of their rays visit the same nodes
  /// Those of the next chunk. They come into the caches while this one is traced, little by little: all at once would
  /// wait for memory.
  LaterVectors next_origins, next_directions;

  ALHAZEN_INLINE void prefetch_next(uint32_t i) const {
    next_origins.prefetch(i);
    next_directions.prefetch(i);
  }
};

/// What they hit.
template <class Real>
struct ChunkHits {
  Real t[PreparedRays<Real>::capacity];         ///< infinity: a miss
  Hit<Real> hit[PreparedRays<Real>::capacity];  ///< or missing_hit; unspecified if `t` alone is wanted

  ALHAZEN_INLINE bool found(uint32_t i) const { return t[i] < infinity<Real>; }
};

template <class Real>
class ChunkTracer {
 public:
  using Rays = PreparedRays<Real>;

  explicit ChunkTracer(const SceneView<Real>& scene) : intersector_(scene), uses_packets_(scene.instances_count == 0) {}

  /// Calls prefetch(hit) for each hit if more than `t` is wanted.
  template <class Prefetch>
  ALHAZEN_NOINLINE void closest_hits(const Rays& rays, bool wants_more, const Prefetch& prefetch,
                                     ChunkHits<Real>& hits) {
    const auto answer = [&](uint32_t i, bool found, const Hit<Real>& hit) {
      rays.prefetch_next(i);
      hits.t[i] = found ? hit.t : infinity<Real>;
      if (!wants_more) return;
      hits.hit[i] = found ? hit : missing_hit<Real>;
      if (found) prefetch(hit);
    };
    constexpr uint32_t width = Rays::packet;
    uint32_t run = 0, others = 0;  // the coherent rays before `first` start at `run`
    for (uint32_t first = 0; first < rays.count; first += width) {
      const uint32_t size = min(width, rays.count - first);
      if (uses_packets_ && size == width && rays.is_coherent[first / width]) continue;
      trace_packets(rays, run, first - run, answer);
      for (uint32_t i = 0; i < size; ++i) others_[others++] = first + i;
      run = first + size;
    }
    trace_packets(rays, run, rays.count - run, answer);
    if (others == rays.count)
      trace_others(
          others, [&](uint32_t i) -> const Ray<Real>& { return rays.rays[i]; },
          [&](uint32_t i) { return rays.limit[i]; }, answer);
    else
      trace_others(
          others, [&](uint32_t i) -> const Ray<Real>& { return rays.rays[others_[i]]; },
          [&](uint32_t i) { return rays.limit[others_[i]]; },
          [&](uint32_t i, bool found, const Hit<Real>& hit) { answer(others_[i], found, hit); });
  }

  ALHAZEN_NOINLINE void occluded(const Rays& rays, uint8_t* to) const {
    intersector_.template trace<true>(
        rays.count, [&](uint32_t i) -> const Ray<Real>& { return rays.rays[i]; },
        [&](uint32_t i) { return rays.limit[i]; },
        [&](uint32_t i, bool found, const Hit<Real>&) {
          rays.prefetch_next(i);
          to[i] = found ? 1 : 0;
        });
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

  template <RayLookup<Real> RayOf, LimitLookup<Real> Limit, HitReceiver<Real> Answer>
  ALHAZEN_NOINLINE void trace_others(uint32_t count, const RayOf& ray, const Limit& t_max, const Answer& answer) const {
    intersector_.template trace<false>(count, ray, t_max, answer);
  }

  Bvh8Intersector<Real> intersector_;
  bool uses_packets_;
  uint32_t others_[Rays::capacity];
};

}  // namespace ALHAZEN_CORE

#pragma once

// Ray queries with the BVH8, for single rays and for batches. If the tree is larger than the caches, 12 rays are
// interleaved: each takes one step in turn, and the data of its next step is prefetched meanwhile to hide latency.
// Coherent rays are traced in packets (packets.h), unless the scene has instances. The hit of a ray does not depend on
// the other rays.

#include <bit>

#include "core/bvh/brute_force/packets.h"
#include "core/bvh/bvh8/packets.h"
#include "core/bvh/bvh8/prefetch.h"
#include "core/bvh/bvh8/traversal.h"

namespace ALHAZEN_CORE {

/// Number of rays whose traversals one core interleaves.
inline constexpr uint32_t interleaved_rays = 12;

/// Bytes up to which a tree stays in the caches of a core. There is little latency to hide then, so rays are traced
/// one by one.
inline constexpr size_t max_cached_bytes = size_t{1} << 19;

/// Answers ray queries with the BVH8, the layout for CPUs.
template <class Real>
class Bvh8Intersector {
 public:
  explicit Bvh8Intersector(const SceneView<Real>& scene)
      : scene_(&scene), brute_force_(scene), fits_cache_(bytes(scene) <= max_cached_bytes) {}

  bool closest_hit(const Ray<Real>& ray, Real t_max, Hit<Real>& hit) const {
    return has_instances() ? traverse<false, true>(ray, t_max, hit) : traverse<false, false>(ray, t_max, hit);
  }

  bool occluded(const Ray<Real>& ray, Real t_max) const {
    Hit<Real> hit;
    return has_instances() ? traverse<true, true>(ray, t_max, hit) : traverse<true, false>(ray, t_max, hit);
  }

  template <bool any_hit, RayLookup<Real> RayOf, LimitLookup<Real> Limit, HitReceiver<Real> Answer>
  void trace(uint32_t count, const RayOf& ray, const Limit& t_max, const Answer& answer) const {
    if (brute_force_.is_worthwhile())
      brute_force_.template trace<any_hit>(count, ray, t_max, answer, [&](uint32_t i) {
        Hit<Real> hit;
        const bool found = traverse<any_hit, false>(ray(i), t_max(i), hit);
        answer(i, found, hit);
      });
    else if (has_instances())
      trace_interleaved<any_hit, true>(count, ray, t_max, answer);
    else if (fits_cache_)
      trace_single<any_hit>(count, ray, t_max, answer);
    else
      trace_interleaved<any_hit>(count, ray, t_max, answer);
  }

  template <RayLookup<Real> RayOf, LimitLookup<Real> Limit, HitReceiver<Real> Answer>
  void trace_coherent(uint32_t count, const RayOf& ray, const Limit& t_max, const Answer& answer) const {
    if (has_instances()) return trace_interleaved<false, true>(count, ray, t_max, answer);
    constexpr uint32_t width = RayPacket<Real>::width;
    const Bvh8Prefetch<Real> prefetch(*scene_);
    RayPacket<Real> packet(prefetch);
    for (uint32_t first = 0; first < count; first += width) {
      const uint32_t size = count - first < width ? count - first : width;
      const auto ray_of = [&](uint32_t i) -> const Ray<Real>& { return ray(first + i); };
      const auto limit_of = [&](uint32_t i) { return t_max(first + i); };
      const auto answer_of = [&](uint32_t i, bool found, const Hit<Real>& hit) { answer(first + i, found, hit); };
      if (size <= width / 4 || !packet.load(size, ray_of, limit_of)) {
        trace<false>(size, ray_of, limit_of, answer_of);
        continue;
      }
      packet.traverse(*scene_);
      for (uint32_t i = 0; i < size; ++i) answer_of(i, packet.found(i), packet.hit(i));
    }
  }

  /// Implements `trace` for trees larger than the caches.
  template <bool any_hit, bool instances = false, RayLookup<Real> RayOf, LimitLookup<Real> Limit,
            HitReceiver<Real> Answer>
  void trace_interleaved(uint32_t count, const RayOf& ray, const Limit& t_max, const Answer& answer) const {
    const Bvh8Prefetch<Real> prefetch(*scene_);
    Bvh8Traversal<any_hit, instances, Real, OctantFirst<any_hit>> traversals[interleaved_rays];
    OctantFirst<any_hit> stacks[interleaved_rays];
    uint32_t query[interleaved_rays], live = 0, next = 0;
    for (; live < interleaved_rays && next < count; ++live, ++next) {
      query[live] = next;
      traversals[live].use(&stacks[live]);
      traversals[live].start(*scene_, ray(next), t_max(next));
    }
    uint32_t order[interleaved_rays];
    for (uint32_t i = 0; i < live; ++i) order[i] = i;
    while (live > 0)
      for (uint32_t i = 0; i < live; ++i) {
        const uint32_t w = order[i];
        auto& traversal = traversals[w];
        if (traversal.step(*scene_)) {
          prefetch(traversal.current());
          continue;
        }
        answer(query[w], traversal.found(), traversal.hit());
        if (next < count) {
          query[w] = next;
          traversal.start(*scene_, ray(next), t_max(next));
          ++next;
        } else {
          order[i--] = order[--live];
        }
      }
  }

 private:
  bool has_instances() const { return scene_->instances_count > 0; }

  template <bool any_hit, RayLookup<Real> RayOf, LimitLookup<Real> Limit, HitReceiver<Real> Answer>
  void trace_single(uint32_t count, const RayOf& ray, const Limit& t_max, const Answer& answer) const {
    // Each hit is reported one ray later, since reading it right after it was stored would stall on store forwarding.
    Hit<Real> hits[2];
    bool found = false;
    for (uint32_t i = 0; i < count; ++i) {
      const bool found_before = found;
      found = traverse<any_hit, false>(ray(i), t_max(i), hits[i & 1]);
      if (i > 0) answer(i - 1, found_before, hits[(i - 1) & 1]);
    }
    if (count > 0) answer(count - 1, found, hits[(count - 1) & 1]);
  }

  template <bool any_hit, bool instances>
  bool traverse(const Ray<Real>& ray, Real t_max, Hit<Real>& hit) const {
    Bvh8Traversal<any_hit, instances, Real, NearestFirst<any_hit>> traversal;
    NearestFirst<any_hit> stack;
    traversal.use(&stack);
    traversal.start(*scene_, ray, t_max);
    while (traversal.step(*scene_)) {
    }
    hit = traversal.hit();
    return traversal.found();
  }

  static size_t bytes(const SceneView<Real>& scene) {
    size_t bytes = scene.bvh8_nodes_count * sizeof(Bvh8Node);
#define ALHAZEN_ADD(X, kind, Record, records, Block, blocks) bytes += scene.blocks##_count * sizeof(Block);
    ALHAZEN_PRIMITIVES(ALHAZEN_ADD, )
#undef ALHAZEN_ADD
    return bytes;
  }

  const SceneView<Real>* scene_;
  BruteForcePackets<Real> brute_force_;
  bool fits_cache_;
};
static_assert(BatchIntersector<Bvh8Intersector<float>, float> && BatchIntersector<Bvh8Intersector<double>, double>);

}  // namespace ALHAZEN_CORE

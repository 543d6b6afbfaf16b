#pragma once

// Closest-hit and any-hit queries over the BVH of bvh8_root.h, for one ray or for many at a time. In a tree larger than
// the caches many are walked in turns, a step each, what the next step of a ray reads being fetched while the others
// have theirs: so the waits for memory and for each other's results overlap. Rays that go much the same way walk in
// packets (simd_packet.h), unless there are instances. What a ray meets does not depend on the others.

#include <bit>

#include "core/bvh/brute_force/packets.h"
#include "core/bvh/bvh8/packets.h"
#include "core/bvh/bvh8/prefetch.h"
#include "core/bvh/bvh8/walk.h"

namespace ALHAZEN_CORE {

/// How many rays take turns.
inline constexpr uint32_t interleaved_rays = 12;

/// In a tree no larger than this, which the caches near a core hold, there is little to wait for: rays walk alone.
inline constexpr size_t max_cached_bytes = size_t{1} << 19;

/// The ray queries that integrators ask, answered by the BVH of CPUs.
template <class Real>
class Bvh8Intersector {
 public:
  explicit Bvh8Intersector(const SceneView<Real>& scene, const void* = nullptr)
      : scene_(&scene), few_(scene), fits_cache_(bytes(scene) <= max_cached_bytes) {}

  /// The nearest hit before t_max; among hits at the same distance that of the lowest primitive.
  bool closest_hit(const Ray<Real>& ray, Real t_max, Hit<Real>& hit) const {
    return has_instances() ? walk<false, true>(ray, t_max, hit) : walk<false, false>(ray, t_max, hit);
  }

  /// Whether anything stands before t_max.
  bool occluded(const Ray<Real>& ray, Real t_max) const {
    Hit<Real> hit;
    return has_instances() ? walk<true, true>(ray, t_max, hit) : walk<true, false>(ray, t_max, hit);
  }

  /// `ray(i)` and `t_max(i)` are query i of `count`; `answer(i, found, hit)` is called once for each, in any order, and
  /// need not look at the hit of an any-hit query.
  template <bool any_hit, class RayOf, class Limit, class Answer>
  void trace(uint32_t count, const RayOf& ray, const Limit& t_max, const Answer& answer) const {
    if (few_.is_worthwhile())
      few_.template trace<any_hit>(count, ray, t_max, answer, [&](uint32_t i) {
        Hit<Real> hit;
        const bool found = walk<any_hit, false>(ray(i), t_max(i), hit);
        answer(i, found, hit);
      });
    else if (has_instances())
      trace_interleaved<any_hit, true>(count, ray, t_max, answer);
    else if (fits_cache_)
      trace_single<any_hit>(count, ray, t_max, answer);
    else
      trace_interleaved<any_hit>(count, ray, t_max, answer);
  }

  /// The same for closest hits of rays of which neighbours go much the same way.
  template <class RayOf, class Limit, class Answer>
  void trace_coherent(uint32_t count, const RayOf& ray, const Limit& t_max, const Answer& answer) const {
    if (has_instances()) return trace_interleaved<false, true>(count, ray, t_max, answer);
    constexpr uint32_t width = RayPacket<Real>::width;
    const Bvh8Prefetch<Real> prefetch(*scene_);
    RayPacket<Real> packet(prefetch);
    for (uint32_t first = 0; first < count; first += width) {
      const uint32_t some = count - first < width ? count - first : width;
      const auto ray_of = [&](uint32_t i) -> const Ray<Real>& { return ray(first + i); };
      const auto limit_of = [&](uint32_t i) { return t_max(first + i); };
      const auto answer_of = [&](uint32_t i, bool found, const Hit<Real>& hit) { answer(first + i, found, hit); };
      if (some <= width / 4 || !packet.load(some, ray_of, limit_of)) {
        trace<false>(some, ray_of, limit_of, answer_of);
        continue;
      }
      packet.walk(*scene_);
      for (uint32_t i = 0; i < some; ++i) answer_of(i, packet.found(i), packet.hit(i));
    }
  }

  /// What `trace` does where the tree is larger than the caches.
  template <bool any_hit, bool instances = false, class RayOf, class Limit, class Answer>
  void trace_interleaved(uint32_t count, const RayOf& ray, const Limit& t_max, const Answer& answer) const {
    const Bvh8Prefetch<Real> prefetch(*scene_);
    Bvh8Traversal<any_hit, instances, Real, OctantFirst<any_hit>> walks[interleaved_rays];
    OctantFirst<any_hit> stacks[interleaved_rays];
    uint32_t query[interleaved_rays], live = 0, next = 0;
    for (; live < interleaved_rays && next < count; ++live, ++next) {
      query[live] = next;
      walks[live].use(&stacks[live]);
      walks[live].start(*scene_, ray(next), t_max(next));
    }
    uint32_t order[interleaved_rays];
    for (uint32_t i = 0; i < live; ++i) order[i] = i;
    while (live > 0)
      for (uint32_t i = 0; i < live; ++i) {
        const uint32_t w = order[i];
        auto& walk = walks[w];
        if (walk.step(*scene_)) {
          prefetch(walk.current());
          continue;
        }
        answer(query[w], walk.found(), walk.hit());
        if (next < count) {
          query[w] = next;
          walk.start(*scene_, ray(next), t_max(next));
          ++next;
        } else {
          order[i--] = order[--live];
        }
      }
  }

 private:
  bool has_instances() const { return scene_->instances_count > 0; }

  template <bool any_hit, class RayOf, class Limit, class Answer>
  void trace_single(uint32_t count, const RayOf& ray, const Limit& t_max, const Answer& answer) const {
    // A hit is handed over one ray later: what has just been written cannot be copied at once.
    Hit<Real> hits[2];
    bool found = false;
    for (uint32_t i = 0; i < count; ++i) {
      const bool found_before = found;
      found = walk<any_hit, false>(ray(i), t_max(i), hits[i & 1]);
      if (i > 0) answer(i - 1, found_before, hits[(i - 1) & 1]);
    }
    if (count > 0) answer(count - 1, found, hits[(count - 1) & 1]);
  }

  template <bool any_hit, bool instances>
  bool walk(const Ray<Real>& ray, Real t_max, Hit<Real>& hit) const {
    Bvh8Traversal<any_hit, instances, Real, NearestFirst<any_hit>> walk;
    NearestFirst<any_hit> stack;
    walk.use(&stack);
    walk.start(*scene_, ray, t_max);
    while (walk.step(*scene_)) {
    }
    hit = walk.hit();
    if (!walk.found()) hit.primitive = PrimitiveId();
    return walk.found();
  }

  static size_t bytes(const SceneView<Real>& scene) {
    return scene.bvh8_nodes_count * sizeof(Bvh8Node) + scene.triangle_blocks_count * sizeof(TriangleBlock<Real>) +
           scene.sphere_blocks_count * sizeof(SphereBlock<Real>) +
           scene.moving_sphere_blocks_count * sizeof(MovingSphereBlock<Real>);
  }

  const SceneView<Real>* scene_;
  BruteForcePackets<Real> few_;
  bool fits_cache_;
};

}  // namespace ALHAZEN_CORE

#pragma once

// The ray queries answered by looking at every primitive in turn, as the report's Algorithm 5 does: the reference that
// the BVH is measured against, in results and in time.

#include "core/bvh/bvh2/traversal.h"

namespace ALHAZEN_CORE {

template <class Real>
class BruteForceIntersector {
 public:
  explicit BruteForceIntersector(const SceneView<Real>& scene, const void* = nullptr) : scene_(&scene) {}

  /// The nearest hit before t_max; among hits at the same distance that of the lowest primitive.
  bool closest_hit(const Ray<Real>& ray, Real t_max, Hit<Real>& hit) const {
    hit = no_hit_before(t_max);
    return search<false>(ray, hit);
  }

  /// Whether anything stands before t_max.
  bool occluded(const Ray<Real>& ray, Real t_max) const {
    Hit<Real> hit = no_hit_before(t_max);
    return search<true>(ray, hit);
  }

  /// Many queries, one after the other (core/bvh/bvh8/traversal.h).
  template <bool any_hit, class RayOf, class Limit, class Answer>
  void trace(uint32_t count, const RayOf& ray, const Limit& t_max, const Answer& answer) const {
    for (uint32_t i = 0; i < count; ++i) {
      Hit<Real> hit;
      const bool found = any_hit ? occluded(ray(i), t_max(i)) : closest_hit(ray(i), t_max(i), hit);
      answer(i, found, hit);
    }
  }

  template <class RayOf, class Limit, class Answer>
  void trace_coherent(uint32_t count, const RayOf& ray, const Limit& t_max, const Answer& answer) const {
    trace<false>(count, ray, t_max, answer);
  }

 private:
  template <bool any_hit>
  bool search(const Ray<Real>& ray, Hit<Real>& hit) const {
    const uint32_t in_world = scene_->objects_count > 0 ? scene_->objects[0].first_primitive : scene_->primitives_count;
    const ShearedRay<Real> sheared = shear_ray(ray);
    bool found = false;
    for (uint32_t i = 0; i < in_world && !(any_hit && found); ++i) {
      const PrimitiveId primitive = scene_->primitives[i];
      if (primitive.kind() == PrimitiveKind::instance)
        found = search_instance(primitive.index(), ray, hit) || found;
      else
        found = intersect_primitive(*scene_, primitive, ray, sheared, hit) || found;
    }
    return found;
  }

  bool search_instance(uint32_t index, const Ray<Real>& ray, Hit<Real>& hit) const {
    const ObjectRecord& object = scene_->objects[scene_->instances[index].object];
    const ShearedRay<Real> sheared = shear_ray(object_ray(*scene_, index, ray));
    Hit<Real> within = hit;
    within.primitive = bound_within(index, hit);
    bool found = false;
    for (uint32_t i = object.first_primitive; i < object.first_primitive + object.triangle_count; ++i)
      found = intersect_primitive(*scene_, scene_->primitives[i], ray, sheared, within) || found;
    if (!found) return false;
    hit = within;
    hit.instance = index;
    return true;
  }

  const SceneView<Real>* scene_;
};

}  // namespace ALHAZEN_CORE

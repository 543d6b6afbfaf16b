#pragma once

// Ray queries that test every primitive. They are the reference for the results and the speed of the BVHs.

#include "core/bvh/bvh2/traversal.h"

namespace ALHAZEN_CORE {

template <class Real>
class BruteForceIntersector {
 public:
  explicit BruteForceIntersector(const SceneView<Real>& scene) : scene_(&scene) {}

  bool closest_hit(const Ray<Real>& ray, Real t_max, Hit<Real>& hit) const {
    hit = end_of_interval(t_max);
    return search<false>(ray, hit);
  }

  bool occluded(const Ray<Real>& ray, Real t_max) const {
    Hit<Real> hit = end_of_interval(t_max);
    return search<true>(ray, hit);
  }

 private:
  template <bool any_hit>
  bool search(const Ray<Real>& ray, Hit<Real>& hit) const {
    const uint32_t in_world = scene_->objects_count > 0 ? scene_->objects[0].first_primitive : scene_->primitives_count;
    const ShearedRay<Real> sheared = shear_ray(ray, scene_->has_narrow_triangles);
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
    const ShearedRay<Real> sheared = shear_ray(object_ray(*scene_, index, ray), scene_->has_narrow_triangles);
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
static_assert(RayIntersector<BruteForceIntersector<float>, float> &&
              RayIntersector<BruteForceIntersector<double>, double>);

}  // namespace ALHAZEN_CORE

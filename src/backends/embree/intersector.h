#pragma once

// The ray queries that integrators ask, answered by Embree. The identifiers of its geometries are our kinds of
// primitives; from embree_instances on they are instances.

#include "backends/embree/api.h"
#include "core/bvh/traversal.h"

namespace ALHAZEN_CORE {

class EmbreeIntersector {
 public:
  EmbreeIntersector(const SceneView<float>& view, const void* tracer)
      : view_(&view), scene_(static_cast<const EmbreeTracer*>(tracer)->scene) {}

  bool closest_hit(const Ray<float>& ray, float t_max, Hit<float>& hit) const {
    if (!is_traced_by_embree(ray, t_max)) return false;
    RTCRayHit query;
    query.ray = embree_ray(ray, t_max);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    intersect_1(scene_, ray, query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    // Where exactly, our own test says: what is spawned there relies on its bounds.
    hit = no_hit_before(t_max);
    hit.primitive = PrimitiveId(PrimitiveKind::moving_sphere, max_primitives_of_a_kind);
    if (query.hit.instID[0] != RTC_INVALID_GEOMETRY_ID) return is_met(query.hit, ray, hit);
    return intersect_primitive(*view_, {static_cast<PrimitiveKind>(query.hit.geomID), query.hit.primID}, ray,
                               shear_ray(ray), hit);
  }

  bool occluded(const Ray<float>& ray, float t_max) const {
    if (!is_traced_by_embree(ray, t_max)) return false;
    RTCRay query = embree_ray(ray, t_max);
    occluded_1(scene_, ray, query);
    return query.tfar < 0;
  }

  /// Many queries, as core/bvh/simd_traversal.h has it; one after the other.
  template <bool any_hit, class RayOf, class Limit, class Answer>
  void trace(uint32_t count, const RayOf& ray, const Limit& t_max, const Answer& answer) const {
    for (uint32_t i = 0; i < count; ++i) {
      Hit<float> hit;
      const bool found = any_hit ? t_max(i) > 0 && occluded(ray(i), t_max(i)) : closest_hit(ray(i), t_max(i), hit);
      answer(i, found, hit);
    }
  }

  template <class RayOf, class Limit, class Answer>
  void trace_coherent(uint32_t count, const RayOf& ray, const Limit& t_max, const Answer& answer) const {
    trace<false>(count, ray, t_max, answer);
  }

 private:
  /// Where our own test meets the triangle of an instance.
  bool is_met(const RTCHit& met, const Ray<float>& ray, Hit<float>& hit) const {
    const uint32_t index = met.instID[0] - embree_instances;
    const uint32_t triangle = view_->objects[view_->instances[index].object].first_triangle + met.primID;
    if (!intersect_primitive(*view_, {PrimitiveKind::triangle, triangle}, ray,
                             shear_ray(object_ray(*view_, index, ray)), hit))
      return false;
    hit.instance = index;
    return true;
  }

  const SceneView<float>* view_;
  RTCScene scene_;
};

}  // namespace ALHAZEN_CORE

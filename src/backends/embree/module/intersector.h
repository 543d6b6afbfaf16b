#pragma once

// Answers ray queries with Embree. The ids of its geometries are our kinds of primitives; from embree_instances on they
// are instances.

#include "backends/embree/module/api.h"
#include "core/bvh/ray_intersector.h"
#include "core/scene_view.h"

namespace ALHAZEN_CORE {

class EmbreeIntersector {
 public:
  using Tracer = EmbreeTracer;

  EmbreeIntersector(const SceneView<float>& view, const Tracer& tracer) : view_(&view), scene_(tracer.scene) {}

  bool closest_hit(const Ray<float>& ray, float t_max, Hit<float>& hit) const {
    if (!is_traced_by_embree(ray, t_max)) return false;
    RTCRayHit query;
    query.ray = embree_ray(ray, t_max);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    intersect_1(scene_, ray, query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    // The barycentric coordinates are rounded, but the interpolated point is still in the plane of the triangle.
    hit = {query.ray.tfar, query.hit.u, query.hit.v, {static_cast<PrimitiveKind>(query.hit.geomID), query.hit.primID}};
    if (query.hit.instID[0] != RTC_INVALID_GEOMETRY_ID) set_instance(query.hit, hit);
    return true;
  }

  bool occluded(const Ray<float>& ray, float t_max) const {
    if (!is_traced_by_embree(ray, t_max)) return false;
    RTCRay query = embree_ray(ray, t_max);
    occluded_1(scene_, ray, query);
    return query.tfar < 0;
  }

 private:
  void set_instance(const RTCHit& of, Hit<float>& hit) const {
    hit.instance = of.instID[0] - embree_instances;
    hit.primitive = {PrimitiveKind::triangle,
                     view_->objects[view_->instances[hit.instance].object].first_triangle + of.primID};
  }

  const SceneView<float>* view_;
  RTCScene scene_;
};
static_assert(RayIntersector<EmbreeIntersector, float>);

}  // namespace ALHAZEN_CORE

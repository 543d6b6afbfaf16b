#pragma once

// Embree 4 where it is, else Embree 3, by the names that both have and the few that differ.

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <bit>

#include "core/math/ray.h"
#include "core/shapes/shape_records.h"
#include "render/kernels/request.h"

namespace ALHAZEN_CORE {

/// The geometry's identifier of the first instance; lower ones are kinds of primitives.
inline constexpr uint32_t embree_instances = static_cast<uint32_t>(PrimitiveKind::instance);

/// Embree takes no coordinate beyond this, its FLT_LARGE, and leaves out geometry that has one.
inline constexpr float max_embree_coordinate = 1.844e18f;

/// Whether Embree may be asked about a ray: where it was built with assertions, as Debian's is, it ends the process on
/// one that is NaN or out of its range. EmbreeScene refuses scenes that reach that far out, so what is left are rays
/// whose arithmetic overflowed; they hit nothing by our own BVHs either.
inline bool is_traced_by_embree(const Ray<float>& ray, float t_max) {
  const Vec3<float> size = abs(ray.origin) + abs(ray.direction);
  return size.x <= max_embree_coordinate && size.y <= max_embree_coordinate && size.z <= max_embree_coordinate &&
         t_max > 0;
}

/// What the intersector is handed besides the scene.
struct EmbreeTracer : ExternalTracer {
  RTCScene scene;
};

#if RTC_VERSION_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;
#else
using EmbreeContext = RTCIntersectContext;
#endif

/// A query's context, and with it the query: filters are shown only the distance of the hit in question, and within
/// instances another ray.
struct EmbreeQuery {
  EmbreeContext context;
  const Ray<float>* ray;
  float t_max;
};

/// Embree's interval is closed at tfar: the float below t_max > 0 keeps ours open.
inline RTCRay embree_ray(const Ray<float>& ray, float t_max) {
  const float t_far = std::bit_cast<float>(std::bit_cast<uint32_t>(t_max) - 1);
  return {ray.origin.x,
          ray.origin.y,
          ray.origin.z,
          0.0f,
          ray.direction.x,
          ray.direction.y,
          ray.direction.z,
          ray.time,
          t_far,
          ~0u,
          0,
          0};
}

/// `query` was made from `ray`.
inline void intersect_1(RTCScene scene, const Ray<float>& ray, RTCRayHit& query) {
  EmbreeQuery of;
  of.ray = &ray;
  of.t_max = query.ray.tfar;
#if RTC_VERSION_MAJOR >= 4
  rtcInitRayQueryContext(&of.context);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &of.context;
  rtcIntersect1(scene, &query, &arguments);
#else
  rtcInitIntersectContext(&of.context);
  rtcIntersect1(scene, &of.context, &query);
#endif
}

/// tfar is negative afterwards where something is hit.
inline void occluded_1(RTCScene scene, const Ray<float>& ray, RTCRay& query) {
  EmbreeQuery of;
  of.ray = &ray;
  of.t_max = query.tfar;
#if RTC_VERSION_MAJOR >= 4
  rtcInitRayQueryContext(&of.context);
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &of.context;
  rtcOccluded1(scene, &query, &arguments);
#else
  rtcInitIntersectContext(&of.context);
  rtcOccluded1(scene, &of.context, &query);
#endif
}

}  // namespace ALHAZEN_CORE

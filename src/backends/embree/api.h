#pragma once

// Embree 4 where it is, else Embree 3, by the names that both have and the few that differ.

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "core/math/ray.h"
#include "core/shapes/records.h"

namespace ALHAZEN_CORE {

/// What the intersector is handed besides the scene.
struct EmbreeTracer {
  RTCScene scene;
};

#if RTC_VERSION_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;
#else
using EmbreeContext = RTCIntersectContext;
#endif

/// A query's context, and with it how far the query goes: filters see but the distance of the hit in question.
struct EmbreeQuery {
  EmbreeContext context;
  float t_max;
};

inline RTCRay embree_ray(const Ray<float>& ray, float t_max) {
  return {ray.origin.x,
          ray.origin.y,
          ray.origin.z,
          0.0f,
          ray.direction.x,
          ray.direction.y,
          ray.direction.z,
          ray.time,
          t_max,
          ~0u,
          0,
          0};
}

inline void intersect_1(RTCScene scene, RTCRayHit& query) {
  EmbreeQuery of;
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

/// tfar is negative afterwards where something was met.
inline void occluded_1(RTCScene scene, RTCRay& ray) {
  EmbreeQuery of;
  of.t_max = ray.tfar;
#if RTC_VERSION_MAJOR >= 4
  rtcInitRayQueryContext(&of.context);
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &of.context;
  rtcOccluded1(scene, &ray, &arguments);
#else
  rtcInitIntersectContext(&of.context);
  rtcOccluded1(scene, &of.context, &ray);
#endif
}

}  // namespace ALHAZEN_CORE

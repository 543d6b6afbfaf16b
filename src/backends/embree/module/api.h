#pragma once

// Includes Embree 4 if it is installed, else Embree 3, and wraps the functions in which they differ.

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

/// The geometry id of the first instance. Lower ids are kinds of primitives.
inline constexpr uint32_t embree_instances = static_cast<uint32_t>(PrimitiveKind::instance);

/// Embree ignores geometry with coordinates beyond this, its FLT_LARGE.
inline constexpr float max_embree_coordinate = 1.844e18f;

/// Returns whether Embree can trace a ray. Embree built with assertions, as Debian's is, aborts the process on rays
/// that contain NaN or exceed its range. EmbreeScene rejects scenes of that extent, so only rays whose arithmetic
/// overflowed are excluded here. They hit nothing in our own BVHs either.
inline bool is_traced_by_embree(const Ray<float>& ray, float t_max) {
  const Vec3<float> size = abs(ray.origin) + abs(ray.direction);
  return size.x <= max_embree_coordinate && size.y <= max_embree_coordinate && size.z <= max_embree_coordinate &&
         t_max > 0;
}

/// Passed to the intersector in addition to the scene.
struct EmbreeTracer : ExternalTracer {
  RTCScene scene;
};

#if RTC_VERSION_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;
#else
using EmbreeContext = RTCIntersectContext;
#endif

/// The context of a query, with a copy of its arguments. Filter functions receive only the distance of the current hit,
/// and within instances a transformed ray.
struct EmbreeQuery {
  EmbreeContext context;
  const Ray<float>* ray;
  float t_max;
};

/// Embree's interval is closed at tfar. The float below t_max > 0 keeps our interval open.
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

/// Finds the closest hit. `query.ray` must be the embree_ray of `ray`.
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

/// Sets query.tfar to a negative value if the ray is occluded. `query` must be the embree_ray of `ray`.
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

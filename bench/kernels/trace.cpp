// Compiled once per instruction set, in its namespace.

#include "core/bvh/bvh8/intersector.h"
#include "kernels/query.h"
#include "render/kernels/kernel_templates.h"
#if defined(ALHAZEN_WITH_EMBREE)
#include "backends/embree/module/intersector.h"
#endif

namespace ALHAZEN_CORE {

namespace {

template <class Real, RayIntersector<Real> Intersector>
uint64_t trace_singly(const void* scene, const ExternalTracer* tracer, const void* queries, uint32_t count,
                      bool any_hit) {
  const Intersector intersector = make_intersector<Intersector>(*static_cast<const SceneView<Real>*>(scene), tracer);
  const Query<Real>* const query = static_cast<const Query<Real>*>(queries);
  uint64_t hits = 0;
  for (uint32_t i = 0; i < count; ++i) {
    Hit<Real> hit;
    hits += any_hit ? intersector.occluded(query[i].ray, query[i].t_max)
                    : intersector.closest_hit(query[i].ray, query[i].t_max, hit);
  }
  return hits;
}

template <bool any_hit, class Real>
uint64_t trace_some(const Bvh8Intersector<Real>& intersector, const Query<Real>* query, uint32_t count) {
  uint64_t hits = 0;
  intersector.template trace<any_hit>(
      count, [&](uint32_t i) -> const Ray<Real>& { return query[i].ray; }, [&](uint32_t i) { return query[i].t_max; },
      [&](uint32_t, bool found, const Hit<Real>&) { hits += found; });
  return hits;
}

template <class Real>
uint64_t trace_coherently(const Bvh8Intersector<Real>& intersector, const Query<Real>* query, uint32_t count) {
  uint64_t hits = 0;
  intersector.trace_coherent(
      count, [&](uint32_t i) -> const Ray<Real>& { return query[i].ray; }, [&](uint32_t i) { return query[i].t_max; },
      [&](uint32_t, bool found, const Hit<Real>&) { hits += found; });
  return hits;
}

template <class Real, bool coherent>
uint64_t trace_together(const void* scene, const ExternalTracer*, const void* queries, uint32_t count, bool any_hit) {
  const Bvh8Intersector<Real> intersector(*static_cast<const SceneView<Real>*>(scene));
  const Query<Real>* const query = static_cast<const Query<Real>*>(queries);
  uint64_t hits = 0;
  constexpr uint32_t at_a_time = 128;  // about the number of active paths of a PathBatch
  for (uint32_t i = 0; i < count; i += at_a_time) {
    const uint32_t some = count - i < at_a_time ? count - i : at_a_time;
    hits += coherent  ? trace_coherently(intersector, query + i, some)
            : any_hit ? trace_some<true>(intersector, query + i, some)
                      : trace_some<false>(intersector, query + i, some);
  }
  return hits;
}

#if defined(ALHAZEN_WITH_EMBREE)
uint64_t trace_by_plain_embree(const void*, const ExternalTracer* tracer, const void* queries, uint32_t count,
                               bool any_hit) {
  const RTCScene scene = static_cast<const EmbreeTracer*>(tracer)->scene;
  const Query<float>* const query = static_cast<const Query<float>*>(queries);
  uint64_t hits = 0;
  for (uint32_t i = 0; i < count; ++i) {
    RTCRayHit of;
    of.ray = embree_ray(query[i].ray, query[i].t_max);
    if (any_hit) {
      occluded_1(scene, query[i].ray, of.ray);
      hits += of.ray.tfar < 0;
    } else {
      of.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      of.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      intersect_1(scene, query[i].ray, of);
      hits += of.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
  }
  return hits;
}
#endif

template <class Real>
TraceQueries select(Call call) {
  switch (call) {
    case Call::one:
      return trace_singly<Real, Bvh8Intersector<Real>>;
    case Call::many:
      return trace_together<Real, false>;
    case Call::coherent:
      return trace_together<Real, true>;
    case Call::plain_embree:
#if defined(ALHAZEN_WITH_EMBREE)
      if constexpr (sizeof(Real) == sizeof(float)) return trace_by_plain_embree;
#endif
      break;
    case Call::embree_backend:
#if defined(ALHAZEN_WITH_EMBREE)
      if constexpr (sizeof(Real) == sizeof(float)) return trace_singly<float, EmbreeIntersector>;
#endif
      break;
  }
  return nullptr;
}

}  // namespace

TraceQueries select_trace(Call call, bool is_double) { return is_double ? select<double>(call) : select<float>(call); }

}  // namespace ALHAZEN_CORE

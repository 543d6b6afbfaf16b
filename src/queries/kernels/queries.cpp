// Kernels for ray queries, compiled once per instruction set, in its namespace.

#include "queries/kernels/chunk_tracer.h"
#include "queries/kernels/hit_writer.h"
#include "queries/kernels/ray_chunk.h"
#include "queries/kernels/request.h"

namespace ALHAZEN_CORE {

namespace {

/// Calls chunk(rays, first) for one chunk after the other.
template <class Real, class Number, class Function>
void for_chunks(const RayQueryRequest<Number>& request, const SceneView<Real>& scene, const Function& chunk) {
  RayChunk<Real, Number> rays(scene);
  const size_t end = request.first + request.count;
  for (size_t first = request.first; first < end; first += rays.capacity) {
    rays.load(request, first, end - first < rays.capacity ? static_cast<uint32_t>(end - first) : rays.capacity);
    chunk(rays, first);
  }
}

template <class Real, class Number>
void closest_hits(const RayQueryRequest<Number>& request) {
  const SceneView<Real>& scene = *static_cast<const SceneView<Real>*>(request.scene);
  ChunkTracer<Real> tracer(scene);
  HitWriter<Real, Number> writer(request, scene);
  const auto prefetch = [&](const Hit<Real>& hit) ALHAZEN_INLINE_LAMBDA { writer.prefetch(hit); };
  ChunkHits<Real> hits;
  for_chunks(request, scene, [&](const RayChunk<Real, Number>& rays, size_t first) {
    tracer.closest_hits(rays, writer.wants_more(), prefetch, hits);
    writer.write(rays, hits, first);
  });
}

template <class Real, class Number>
void occluded(const RayQueryRequest<Number>& request) {
  const SceneView<Real>& scene = *static_cast<const SceneView<Real>*>(request.scene);
  const ChunkTracer<Real> tracer(scene);
  for_chunks(request, scene, [&](const RayChunk<Real, Number>& rays, size_t first) {
    tracer.occluded(rays, request.occluded + first);
  });
}

template <class Number>
RayQueryKernel<Number> select(bool scene_in_double, bool any_hit) {
  if (scene_in_double) return any_hit ? occluded<double, Number> : closest_hits<double, Number>;
  return any_hit ? occluded<float, Number> : closest_hits<float, Number>;
}

}  // namespace

RayQueryKernel<float> select_float_queries(bool scene_in_double, bool any_hit) {
  return select<float>(scene_in_double, any_hit);
}
RayQueryKernel<double> select_double_queries(bool scene_in_double, bool any_hit) {
  return select<double>(scene_in_double, any_hit);
}

}  // namespace ALHAZEN_CORE

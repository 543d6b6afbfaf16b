// Kernels for ray queries, compiled once per instruction set, in its namespace.

#include "core/bvh/bvh8/intersector.h"
#include "queries/kernels/hit_writer.h"
#include "queries/kernels/ray_chunk.h"
#include "queries/kernels/request.h"

namespace ALHAZEN_CORE {

namespace {

/// Traces the rays of a chunk: coherent ones in packets, the others together.
template <class Real, class Number>
class ChunkTracer {
 public:
  using Chunk = RayChunk<Real, Number>;

  /// Few primitives are tested faster by brute force, which any rays may share.
  explicit ChunkTracer(const SceneView<Real>& scene)
      : intersector_(scene),
        uses_packets_(scene.instances_count == 0 && !BruteForcePackets<Real>(scene).is_worthwhile()) {
    const Vec3<Real> size = scene.bounds.high - scene.bounds.low;
    max_spread_ = max_component(size) * Real(1.0 / 64);
  }

  template <HitReceiver<Real> Answer>
  void closest_hits(const Chunk& rays, uint32_t count, const Answer& answer) {
    constexpr uint32_t width = RayPacket<Real>::width;
    uint32_t run = 0, others = 0;  // the coherent rays before `first` start at `run`
    for (uint32_t first = 0; first < count; first += width) {
      const uint32_t size = count - first < width ? count - first : width;
      if (uses_packets_ && rays.is_coherent(first, size, max_spread_)) continue;
      trace_packets(rays, run, first - run, answer);
      for (uint32_t i = 0; i < size; ++i) others_[others++] = first + i;
      run = first + size;
    }
    trace_packets(rays, run, count - run, answer);
    intersector_.template trace<false>(
        others, [&](uint32_t i) -> const Ray<Real>& { return rays.ray(others_[i]); },
        [&](uint32_t i) { return rays.limit(others_[i]); },
        [&](uint32_t i, bool found, const Hit<Real>& hit) { answer(others_[i], found, hit); });
  }

  void occluded(const Chunk& rays, uint32_t count, uint8_t* to) const {
    intersector_.template trace<true>(
        count, [&](uint32_t i) -> const Ray<Real>& { return rays.ray(i); }, [&](uint32_t i) { return rays.limit(i); },
        [&](uint32_t i, bool found, const Hit<Real>&) { to[i] = found ? 1 : 0; });
  }

 private:
  template <HitReceiver<Real> Answer>
  void trace_packets(const Chunk& rays, uint32_t first, uint32_t count, const Answer& answer) const {
    if (count == 0) return;
    intersector_.trace_coherent(
        count, [&](uint32_t i) -> const Ray<Real>& { return rays.ray(first + i); },
        [&](uint32_t i) { return rays.limit(first + i); },
        [&](uint32_t i, bool found, const Hit<Real>& hit) { answer(first + i, found, hit); });
  }

  Bvh8Intersector<Real> intersector_;
  bool uses_packets_;
  Real max_spread_;  ///< of the origins of coherent rays
  uint32_t others_[Chunk::capacity];
};

/// Calls chunk(rays, first, count) for one chunk after the other.
template <class Real, class Number, class Function>
void for_chunks(const RayQueryRequest<Number>& request, const Function& chunk) {
  RayChunk<Real, Number> rays;
  const size_t end = request.first + request.count;
  for (size_t first = request.first; first < end; first += rays.capacity) {
    const uint32_t count = end - first < rays.capacity ? static_cast<uint32_t>(end - first) : rays.capacity;
    rays.load(request, first, count);
    chunk(rays, first, count);
  }
}

template <class Real, class Number>
void closest_hits(const RayQueryRequest<Number>& request) {
  const SceneView<Real>& scene = *static_cast<const SceneView<Real>*>(request.scene);
  using Chunk = RayChunk<Real, Number>;
  ChunkTracer<Real, Number> tracer(scene);
  const HitWriter<Real, Number> writer(request, scene);
  const bool wants_records = writer.wants_records();
  Hit<Real> hits[Chunk::capacity];
  bool found[Chunk::capacity];
  for_chunks<Real>(request, [&](const Chunk& rays, size_t first, uint32_t count) {
    tracer.closest_hits(rays, count, [&](uint32_t i, bool is_hit, const Hit<Real>& hit) {
      hits[i] = hit;
      found[i] = is_hit;
      if (is_hit && wants_records) prefetch_primitive(scene, hit.primitive);
    });
    writer.write(rays, first, count, found, hits);
  });
}

template <class Real, class Number>
void occluded(const RayQueryRequest<Number>& request) {
  const ChunkTracer<Real, Number> tracer(*static_cast<const SceneView<Real>*>(request.scene));
  for_chunks<Real>(request, [&](const RayChunk<Real, Number>& rays, size_t first, uint32_t count) {
    tracer.occluded(rays, count, request.occluded + first);
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

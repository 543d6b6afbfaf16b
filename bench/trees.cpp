// Compares the binary BVH with the compressed wide one of GPUs, on the host: build time, memory, and rays per second.
// The mesh is scenes/knot.ply.gz or the file in ALHAZEN_BENCH_MESH.

#include <benchmark/benchmark.h>

#include <cstdlib>

#include "compile/compile_scene.h"
#include "core/bvh/cwbvh/traversal.h"
#include "io/read_scene.h"
#include "support/random.h"

namespace alhazen::impl {
namespace {

CompiledScene<float> read_mesh(const BvhLayouts& layouts) {
  const char* file = std::getenv("ALHAZEN_BENCH_MESH");
  Diagnostics diagnostics;
  Scene scene = read_scene(file ? file : ALHAZEN_SOURCE_DIR "/scenes/knot.ply.gz", diagnostics);
  return compile_scene<float>(std::move(scene), CompileOptions{64, 64, 0, layouts}, diagnostics);
}

const CompiledScene<float>& mesh() {
  static const CompiledScene<float> flat = read_mesh({BvhLayout::bvh2, BvhLayout::cwbvh});
  return flat;
}

/// From points around the mesh to points within its bounds: incoherent, as after some bounces.
std::vector<Ray<float>> incoherent_rays() {
  const Bvh2Node<float>& root = mesh().view.bvh2_nodes[0];
  const Vec3<float> size = root.high() - root.low(), centre = root.low() + size * 0.5f;
  test::Random random(1);
  std::vector<Ray<float>> rays(size_t{1} << 16);
  for (Ray<float>& ray : rays) {
    const Vec3<float> to = centre + size * convert<float>(random.in_box(-0.4, 0.4));
    ray.origin = centre + size * convert<float>(random.in_box(-1, 1));
    ray.direction = normalize(to - ray.origin);
  }
  return rays;
}

template <RayIntersector<float> Intersector>
void closest_hit(benchmark::State& state) {
  static const std::vector<Ray<float>> rays = incoherent_rays();
  const Intersector intersector(mesh().view);
  uint64_t hits = 0;
  for (auto _ : state)
    for (const Ray<float>& ray : rays) {
      Hit<float> hit;
      hits += intersector.closest_hit(ray, infinity<float>, hit);
    }
  state.counters["rays"] =
      benchmark::Counter(static_cast<double>(rays.size()), benchmark::Counter::kIsIterationInvariantRate);
  state.counters["hit %"] = benchmark::Counter(100.0 * static_cast<double>(hits) / static_cast<double>(rays.size()),
                                               benchmark::Counter::kAvgIterations);
}

void build(benchmark::State& state, const BvhLayouts& layouts) {
  for (auto _ : state) {
    const CompiledScene<float> flat = read_mesh(layouts);
    state.SetIterationTime(flat.statistics.build_seconds);
  }
  const SceneView<float>& view = mesh().view;
  const uint64_t bytes = layouts.has(BvhLayout::cwbvh) ? view.cwbvh_nodes_count * sizeof(CwbvhNode)
                                                       : view.bvh2_nodes_count * sizeof(Bvh2Node<float>);
  state.counters["triangles"] = static_cast<double>(view.triangles_count);
  state.counters["bytes a triangle"] = static_cast<double>(bytes) / static_cast<double>(view.triangles_count);
}

BENCHMARK_CAPTURE(build, bvh2, {BvhLayout::bvh2})
    ->Name("mesh/build bvh2")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(build, cwbvh, {BvhLayout::bvh2, BvhLayout::cwbvh})
    ->Name("mesh/build bvh2 and cwbvh")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(closest_hit<Bvh2Intersector<float>>)->Name("mesh/closest hit bvh2")->Unit(benchmark::kMillisecond);
BENCHMARK(closest_hit<CwbvhIntersector<>>)->Name("mesh/closest hit cwbvh")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace alhazen::impl

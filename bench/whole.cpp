// Whole renders by `path` on one core, with the same samples whose rays rays.cpp traces by Embree; and the build times
// of the trees, with as many threads as the machine has processors.

#include <benchmark/benchmark.h>

#include <thread>

#include "compile/compile_scene.h"
#include "recorded.h"
#include "render/sample_kernel.h"

namespace alhazen::impl {
namespace {

template <class Real>
void render(benchmark::State& state, const std::string& scene) {
  const Recorded<Real>& recorded = Recorded<Real>::of(scene);
  const SampleKernel<Real> kernel = select_sample_kernel<Real>(IntegratorKind::path, SamplerType::sobol);
  std::vector<BlockRequest> requests;
  std::vector<BlockSum<Real>> sums(max_blocks_per_request);
  uint64_t rays = 0;
  const auto take = [&] {
    kernel(recorded.flat.view, nullptr, 0, bench_segments, requests.data(), static_cast<uint32_t>(requests.size()),
           sums.data(), {.first_hit = false});
    for (size_t i = 0; i < requests.size(); ++i) rays += sums[i].segments + sums[i].shadow_rays;
    requests.clear();
  };
  for (auto _ : state) {
    rays = 0;
    for (uint32_t y = 0; y < bench_height; ++y)
      for (uint32_t x = 0; x < bench_width; ++x)
        for (uint32_t first = 0; first < bench_samples; first += samples_per_block) {
          requests.push_back({x, y, first, samples_per_block});
          if (requests.size() == max_blocks_per_request) take();
        }
    take();
  }
  state.counters["rays"] = benchmark::Counter(static_cast<double>(rays), benchmark::Counter::kIsIterationInvariantRate);
}

int processors() { return static_cast<int>(std::thread::hardware_concurrency()); }

template <class Real>
void build_ours(benchmark::State& state, const std::string& scene) {
  double bytes = 0;
  for (auto _ : state) {
    Diagnostics diagnostics;
    const CompiledScene<Real> flat = compile_scene<Real>(
        read_bench_scene(scene), CompileOptions{64, 64, processors(), {BvhLayout::bvh8}}, diagnostics);
    state.SetIterationTime(flat.statistics.build_seconds);
    bytes = static_cast<double>(flat.statistics.tree_bytes) / static_cast<double>(flat.statistics.triangles);
  }
  state.counters["bytes a triangle"] = bytes;
}

#if defined(ALHAZEN_WITH_EMBREE)
void build_embree(benchmark::State& state, const std::string& scene) {
  Diagnostics diagnostics;
  const CompiledScene<float> flat =
      compile_scene<float>(read_bench_scene(scene), CompileOptions{64, 64, processors(), {}}, diagnostics);
  for (auto _ : state) PlainEmbree(flat.view, processors());
}
#endif

const bool is_registered = [] {
  for (const std::string scene : bench_scenes) {
    benchmark::RegisterBenchmark(("whole/" + scene + "/float path").c_str(), render<float>, scene)
        ->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(("whole/" + scene + "/double path").c_str(), render<double>, scene)
        ->Unit(benchmark::kMillisecond);
  }
  for (const std::string scene : {"knot", "mesh"}) {
    benchmark::RegisterBenchmark(("build/" + scene + "/float ours").c_str(), build_ours<float>, scene)
        ->Unit(benchmark::kMillisecond)
        ->UseManualTime();
    benchmark::RegisterBenchmark(("build/" + scene + "/double ours").c_str(), build_ours<double>, scene)
        ->Unit(benchmark::kMillisecond)
        ->UseManualTime();
#if defined(ALHAZEN_WITH_EMBREE)
    benchmark::RegisterBenchmark(("build/" + scene + "/float embree").c_str(), build_embree, scene)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
#endif
  }
  return true;
}();

}  // namespace
}  // namespace alhazen::impl

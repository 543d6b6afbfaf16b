// Whole renders of scenes/spheres.pbrt: compares the CPU engines with each other, and the BVH with the linear scan of
// the report's Algorithm 5. Run by scripts/bench.py, which prints ratios.

#include <benchmark/benchmark.h>

#include "compile/compile_scene.h"
#include "core/bvh/brute_force/intersector.h"
#include "core/bvh/ray_intersector.h"
#include "io/pbrt/pbrt.h"
#include "render/backend.h"
#include "render/kernels/kernel_templates.h"

namespace alhazen::impl {
namespace {

constexpr int64_t image_size = 200;
constexpr uint32_t samples = 16;

template <class Real>
struct SpheresScene {
  CompiledScene<Real> flat;
  RenderSettings settings;

  static const SpheresScene& get() {
    static const SpheresScene scene = load();
    return scene;
  }

 private:
  static SpheresScene load() {
    Diagnostics diagnostics;
    Scene scene = read_pbrt(ALHAZEN_SOURCE_DIR "/scenes/spheres.pbrt", diagnostics);
    Settings asked;
    asked.width = asked.height = image_size;
    asked.integrator = "iterative";
    asked.samples_per_pixel = samples;
    SpheresScene loaded;
    loaded.settings = resolve_settings(asked, scene);
    loaded.flat = compile_scene<Real>(std::move(scene), CompileOptions{image_size, image_size, 0, {BvhLayout::bvh8}},
                                      diagnostics);
    return loaded;
  }
};

template <class Real>
void render(benchmark::State& state, const std::string& backend_name, const std::string& strategy,
            const std::string& schedule, int threads, SampleKernel<Real> kernel) {
  const SpheresScene<Real>& scene = SpheresScene<Real>::get();
  RenderSettings settings = scene.settings;
  settings.backend = backend_name;
  const auto backend = make_backend(backend_name);
  settings.strategy = parse_strategy(backend->traits(), strategy);
  settings.schedule = parse_schedule(schedule);
  settings.threads = threads;
  backend->start(settings);
  uint64_t rays = 0;
  for (auto _ : state) {
    Film<Real> film(settings.window, settings.aovs);
    RenderControl control(threads);
    backend->render_pass(
        RenderPass<Real>{scene.flat, kernel, settings, film, control, 0, samples, settings.integrator});
    for (const ThreadStatistics& thread : control.threads()) rays += thread.rays + thread.shadow_rays;
  }
  state.counters["rays"] = benchmark::Counter(static_cast<double>(rays), benchmark::Counter::kIsRate);
}

template <class Real>
SampleKernel<Real> kernel_of(IntegratorKind integrator) {
  return select_sample_kernel<Real>(integrator, SamplerType::sobol);
}

template <class Real>
void register_precision(const std::string& precision) {
  const auto add = [&](const std::string& name, auto&&... arguments) {
    benchmark::RegisterBenchmark((precision + "/" + name).c_str(), render<Real>, arguments...)
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  };
  const SampleKernel<Real> iterative = kernel_of<Real>(IntegratorKind::iterative);
  add("serial", "serial", "", "dynamic", 1, iterative);
  add("serial path", "serial", "", "dynamic", 1, kernel_of<Real>(IntegratorKind::path));
  for (const char* strategy : {"rows", "collapse", "rows+reduction", "reduction", "tiles"})
    add(std::string("openmp 2 ") + strategy + " dynamic", "openmp", strategy, "dynamic", 2, iterative);
  for (const char* schedule : {"static", "guided"})
    add(std::string("openmp 2 rows ") + schedule, "openmp", "rows", schedule, 2, iterative);
  add("serial linear scan", "serial", "", "dynamic", 1,
      SampleKernel<Real>(take_blocks<IntegratorKind::iterative, SobolSampler,
                                     SequentialBatches<Real, BruteForceIntersector<Real>>, Real>));
}

}  // namespace
}  // namespace alhazen::impl

int main(int argc, char** argv) {
  alhazen::impl::register_precision<float>("float");
  alhazen::impl::register_precision<double>("double");
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}

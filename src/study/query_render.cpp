#include "study/query_render.h"

#include <algorithm>
#include <chrono>
#include <ctime>

#include "render/backend.h"

namespace alhazen {

ALHAZEN_DECLARE_KERNEL(RawKernel select_study_kernel(bool brute_force, bool in_double))

namespace study {

namespace {

/// Whether to continue is checked between passes. They are small, since a pass of a linear scan may take long.
constexpr uint32_t pass_samples = samples_per_block;

template <class Real>
RenderStatistics render(Scene&& scene, const RenderSettings& settings, Queries queries,
                        const std::function<bool()>& go_on, double& processor_seconds, Diagnostics& diagnostics) {
  RenderStatistics statistics;
  statistics.settings = settings;
  BvhLayouts layouts;
  if (queries == Queries::binary_bvh) layouts.add(BvhLayout::bvh2);
  const CompiledScene<Real> flat =
      compile_scene<Real>(std::move(scene), {settings.width, settings.height, settings.threads, layouts}, diagnostics);
  statistics.scene_sizes = flat.statistics;
  statistics.build_seconds = flat.statistics.build_seconds;
  const auto select = ALHAZEN_KERNEL_OF(instruction_sets().back(), select_study_kernel);
  const SampleKernel<Real> kernel(select(queries == Queries::linear_scan, sizeof(Real) == sizeof(double)));
  const std::unique_ptr<Backend> backend = make_backend("serial");
  Film<Real> film(settings.window, settings.aovs, FilmExtras{flat.view.filter.has_negative != 0});
  RenderControl control(1);
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t processor_start = std::clock();
  while (statistics.samples_per_pixel < settings.samples_per_pixel && go_on()) {
    const uint32_t count = std::min(pass_samples, settings.samples_per_pixel - statistics.samples_per_pixel);
    backend->render_pass(RenderPass<Real>{flat, kernel, settings, film, control, statistics.samples_per_pixel, count,
                                          settings.integrator});
    statistics.samples_per_pixel += count;
  }
  statistics.render_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  processor_seconds = static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC;
  statistics.complete = statistics.samples_per_pixel == settings.samples_per_pixel;
  statistics.threads = control.threads();
  statistics.camera_samples = control.thread(0).samples;
  statistics.rays = control.thread(0).rays;
  return statistics;
}

}  // namespace

RenderStatistics render_by_queries(Scene&& scene, const RenderSettings& settings, Queries queries,
                                   const std::function<bool()>& go_on, double& processor_seconds,
                                   Diagnostics& diagnostics) {
  return settings.precision == Precision::single
             ? render<float>(std::move(scene), settings, queries, go_on, processor_seconds, diagnostics)
             : render<double>(std::move(scene), settings, queries, go_on, processor_seconds, diagnostics);
}

}  // namespace study
}  // namespace alhazen

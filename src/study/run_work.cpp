#include "study/run_work.h"

#include <sys/resource.h>

#include <algorithm>
#include <thread>

#include "core/film/block_sum.h"
#include "render/renderer.h"
#include "study/disturbance.h"
#include "study/objects_scene.h"
#include "study/query_kernels.h"

namespace alhazen::impl::study {

namespace {

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// What the process has used since it started.
struct Usage {
  double processor_seconds = 0;  ///< user and system time of all threads
  uint64_t switches = 0;         ///< how often one of them lost its processor before it would wait
  double idle = 0;               ///< idle_seconds
};

Usage usage_of_process() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return {seconds(usage.ru_utime) + seconds(usage.ru_stime), static_cast<uint64_t>(usage.ru_nivcsw), idle_seconds()};
}

Outcome render(const Work& work, Scene&& scene, const RenderSettings& settings, bool keep_image, const GoOn& go_on) {
  Outcome outcome;
  Diagnostics diagnostics;
  RenderEvents events;
  Usage start;
  events.progress = [&](const Progress&) { return go_on(); };
  events.started = [&](const RenderStatistics&) { start = usage_of_process(); };
  if (work.queries != Queries::of_backend) events.kernel = kernel_of(work.queries, settings.precision);
  const Rendering rendering = render_scene(std::move(scene), settings, 0, events, diagnostics);
  const Usage end = usage_of_process();
  outcome.statistics = rendering.statistics;
  outcome.switches = end.switches - start.switches;
  if (!settings.runs_on_device)
    outcome.processor_fraction = processor_fraction(
        {outcome.statistics.render_seconds, end.processor_seconds - start.processor_seconds, end.idle - start.idle},
        outcome.statistics.threads, std::max(1, static_cast<int>(std::thread::hardware_concurrency())));
  if (keep_image) outcome.image = image_of(rendering.source());
  outcome.status = outcome.statistics.complete ? TrialStatus::ok : TrialStatus::not_run;
  return outcome;
}

}  // namespace

Outcome run_work(const Work& work, const Scene& scene, bool keep_image, const GoOn& go_on) {
  Outcome outcome;
  try {
    Scene own = work.objects > 0 ? cloud_of_spheres(work.objects, work.is_glass) : scene;
    const RenderSettings settings = resolve_settings(work.settings, own);
    return render(work, std::move(own), settings, keep_image, go_on);
  } catch (const InputError& error) {
    outcome.status = TrialStatus::unavailable;
    outcome.reason = first_line(error.what());
  } catch (const UnsupportedError& error) {
    outcome.status = TrialStatus::unavailable;
    outcome.reason = first_line(error.what());
  } catch (const TooLargeError& error) {
    outcome.status = TrialStatus::unavailable;
    outcome.reason = first_line(error.what());
  } catch (const std::bad_alloc&) {
    outcome.status = TrialStatus::failed;
    outcome.reason = "out of memory";
  } catch (const std::exception& error) {
    outcome.status = TrialStatus::failed;
    outcome.reason = first_line(error.what());
  }
  return outcome;
}

void warm_up(const Work& work, const Scene& scene, const GoOn& go_on) {
  Work small = work;
  const int64_t few = samples_per_block, asked = work.settings.samples_per_pixel;
  small.settings.samples_per_pixel = asked > 0 ? std::clamp(asked / 4, int64_t{1}, few) : few;
  run_work(small, scene, false, go_on);
}

}  // namespace alhazen::impl::study

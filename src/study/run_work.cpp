#include "study/run_work.h"

#include <sys/resource.h>

#include <algorithm>

#include "core/film/block_sum.h"
#include "render/renderer.h"
#include "study/objects_scene.h"
#include "study/query_render.h"

namespace alhazen::study {

namespace {

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

/// User and system time of the process.
double processor_time() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

Outcome render(const Work& work, Scene&& scene, const RenderSettings& settings, bool keep_image, const GoOn& go_on) {
  Outcome outcome;
  Diagnostics diagnostics;
  if (work.queries != Queries::of_backend) {
    outcome.statistics =
        render_by_queries(std::move(scene), settings, work.queries, go_on, outcome.processor_seconds, diagnostics);
  } else {
    RenderEvents events;
    double start = 0;
    events.progress = [&](const Progress&) { return go_on(); };
    events.started = [&](const RenderStatistics&) { start = processor_time(); };
    const Rendering rendering = render_scene(std::move(scene), settings, 0, events, diagnostics);
    outcome.processor_seconds = processor_time() - start;
    outcome.statistics = rendering.statistics;
    if (keep_image) outcome.image = image_of(rendering.source());
  }
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

}  // namespace alhazen::study

#pragma once

// Renders in which rays are answered by something that no backend uses: by one thread, with `iterative` and `sobol`.

#include <functional>

#include "render/renderer.h"
#include "study/trial.h"

namespace alhazen::study {

/// As render_scene. `settings` are those of the serial backend; of the statistics, times and counts are filled in.
/// `processor_seconds` receives the processor time of the samples.
RenderStatistics render_by_queries(Scene&& scene, const RenderSettings& settings, Queries queries,
                                   const std::function<bool()>& go_on, double& processor_seconds,
                                   Diagnostics& diagnostics);

}  // namespace alhazen::study

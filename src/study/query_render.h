#pragma once

// Renders with ray queries that no backend uses: on one thread, with `iterative` and `sobol`.

#include <functional>

#include "render/renderer.h"
#include "study/trial.h"

namespace alhazen::study {

/// As render_scene. `settings` are those of the serial backend; only times and counts of the statistics are set.
/// `processor_seconds` receives the processor time of taking samples.
RenderStatistics render_by_queries(Scene&& scene, const RenderSettings& settings, Queries queries,
                                   const std::function<bool()>& go_on, double& processor_seconds,
                                   Diagnostics& diagnostics);

}  // namespace alhazen::study

#pragma once

// Runs a work once, from the scene to its results.

#include <functional>
#include <optional>

#include "images/image.h"
#include "render/statistics.h"
#include "scene/scene.h"
#include "study/trial.h"

namespace alhazen::impl::study {

struct Outcome {
  TrialStatus status = TrialStatus::not_run;  ///< not_run: it was stopped
  std::string reason;
  RenderStatistics statistics;
  double processor_fraction = 1;  ///< that the CPU's threads received (disturbance.h)
  uint64_t switches = 0;          ///< involuntary context switches of all threads while it rendered
  std::optional<Image> image;
};

/// Returns false to ask for an early end.
using GoOn = std::function<bool()>;

/// `scene` is the study's. Failures are not thrown but returned as status and reason, except running out of memory
/// before rendering.
Outcome run_work(const Work& work, const Scene& scene, bool keep_image, const GoOn& go_on);

/// The same with a few samples per pixel, to exclude one-time costs from the measurement.
void warm_up(const Work& work, const Scene& scene, const GoOn& go_on);

}  // namespace alhazen::impl::study

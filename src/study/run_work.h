#pragma once

// Runs a work once: from the scene that it is about to what came out.

#include <functional>
#include <optional>

#include "images/image.h"
#include "render/statistics.h"
#include "scene/scene.h"
#include "study/trial.h"

namespace alhazen::study {

struct Outcome {
  TrialStatus status = TrialStatus::not_run;  ///< not_run: it was stopped
  std::string reason;
  RenderStatistics statistics;
  double processor_seconds = 0;  ///< of all threads of this process, while it rendered
  std::optional<Image> picture;
};

/// False asks for an end as soon as may be.
using GoOn = std::function<bool()>;

/// `scene` is the study's. What cannot be done is no exception but a status and its reason; only memory that runs out
/// on the way here is thrown.
Outcome run_work(const Work& work, const Scene& scene, bool keep_picture, const GoOn& go_on);

/// The same with a few samples a pixel, so that what takes its time only once has taken it.
void warm_up(const Work& work, const Scene& scene, const GoOn& go_on);

/// The whole picture of a rendering.
Image image_of(const ImageSource& source);

}  // namespace alhazen::study

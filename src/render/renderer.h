#pragma once

// From a described scene and settings to a film: compile, then pass after pass until all samples are taken, the time is
// up or somebody stops it.

#include <functional>
#include <memory>
#include <variant>

#include "render/denoiser.h"
#include "render/film.h"
#include "render/settings.h"
#include "render/statistics.h"
#include "scene/scene.h"

namespace alhazen {

struct RenderEvents {
  /// Called about ten times a second, and once at the end, from a thread of its own. False stops the render. So does an
  /// exception, which render_scene throws again on the thread that called it.
  ProgressFunction progress;
  /// Called before the first sample, when the scene is ready.
  std::function<void(const RenderStatistics&)> started;
  /// Called between passes, on the thread that called render_scene, where `diagnostics` has got another warning.
  std::function<void()> warned;
};

class Rendering {
 public:
  using AnyFilm = std::variant<std::unique_ptr<Film<float>>, std::unique_ptr<Film<double>>>;

  AnyFilm film;
  std::vector<float> denoised;  ///< three floats a pixel, in the place of the film's radiance; empty: not denoised
  RenderStatistics statistics;

  /// False where it was stopped before the first sample: there is nothing to show.
  bool has_samples() const;
  /// Rows of the picture as means so far. Refers to this object.
  ImageSource source() const;
};

/// What a denoiser takes of a picture with the layers albedo and normal.
NoisyPicture noisy_picture(const ImageSource& source);

/// `load_seconds` is what reading the scene took, for the statistics. Throws InputError, RenderError, std::bad_alloc,
/// and what `events` throws.
Rendering render_scene(Scene&& scene, const RenderSettings& settings, double load_seconds, const RenderEvents& events,
                       Diagnostics& diagnostics);

}  // namespace alhazen

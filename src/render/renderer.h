#pragma once

// Renders a scene description with given settings to a film: compiles the scene, then runs passes until all samples are
// taken, the time is up or the render is stopped.

#include <functional>
#include <memory>
#include <optional>
#include <variant>

#include "compile/compile_scene.h"
#include "render/denoiser.h"
#include "render/film.h"
#include "render/sample_kernel.h"
#include "render/settings.h"
#include "render/statistics.h"
#include "scene/scene.h"

namespace alhazen {

/// A kernel instead of the one that the settings select, and the BVHs that it traces rays by. Its precision and sampler
/// must be those of the settings.
struct KernelChoice {
  RawKernel kernel = nullptr;
  BvhLayouts layouts;
};

struct RenderEvents {
  /// Called about ten times a second, and once at the end, from its own thread. Returning false stops the render. So
  /// does an exception, which render_scene rethrows on the thread that called it.
  ProgressFunction progress;
  /// Called before the first sample, when the scene is compiled.
  std::function<void(const RenderStatistics&)> started;
  /// Called between passes, on the thread that called render_scene, if `diagnostics` has a new warning.
  std::function<void()> warned;
  /// For comparisons of kernels on CPUs.
  std::optional<KernelChoice> kernel = {};
};

class Rendering {
 public:
  using AnyFilm = std::variant<std::unique_ptr<Film<float>>, std::unique_ptr<Film<double>>>;

  AnyFilm film;
  std::vector<float> denoised;  ///< three floats per pixel, which replace the film's radiance; empty: not denoised
  RenderStatistics statistics;

  /// False if stopped before the first sample: there is nothing to show.
  bool has_samples() const;
  /// Rows of the image as means so far. It refers to this object.
  ImageSource source() const;
  /// The input of denoisers, from a film that was made for denoising.
  NoisyImage noisy_image() const;
};

/// `load_seconds` is the time taken to read the scene, for the statistics. Throws InputError, RenderError,
/// std::bad_alloc, and anything that `events` throws.
Rendering render_scene(Scene&& scene, const RenderSettings& settings, double load_seconds, const RenderEvents& events,
                       Diagnostics& diagnostics);

}  // namespace alhazen

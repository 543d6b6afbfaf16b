#pragma once

// Renders a scene again and again, pass by pass if it is to be seen meanwhile, and builds anew only what has changed.
//
//   alhazen::Renderer renderer(settings);
//   for (renderer.start(scene); renderer.render_pass();) show(renderer.image());
//   scene.look_at({2, 1, 3}, {0, 0, 0});
//   const alhazen::RenderedImage other_side = renderer.render(scene);

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "alhazen/alhazen.h"
#include "alhazen/scene.h"
#include "alhazen/version.h"

namespace alhazen::impl {
struct RendererState;
}

namespace ALHAZEN_NAMESPACE {

/// What `start` did.
struct BuildReport {
  /// True if everything was built. False if the scene that was built before is used, with these parts of it built anew:
  bool is_new = false;
  bool materials = false;    ///< values of materials and textures
  bool lights = false;       ///< values of all lights, and how they are chosen among
  bool environment = false;  ///< environment maps, and images of lights, with their distributions
  bool transforms = false;   ///< where shapes and instances are, and the BVH of the world; none of groups
  double seconds = 0;        ///< that `start` took
};

/// Keeps what it built of a scene, its BVH above all, and a copy of what it needs: scenes may be changed and destroyed
/// while it renders. Each `start` compares the scene with what was built. Nothing is built for another camera (of the
/// scene or by settings), image size, crop, number of samples, seed, noise target, guiding, denoiser, and layers unless
/// they need names or light groups that were not built. Only what depends on it is built for
/// - other values and kinds of materials and textures, as long as no surface begins or ceases to be one-sided, to have
///   an opacity, or to use uv coordinates, and no texture of a light changes;
/// - other values, kinds and numbers of lights, also by settings, and another emission of shapes that emit before and
///   after, as long as layers for light groups need no other groups;
/// - another environment;
/// - other transforms of instances and of shapes in the world, as long as no group begins or ceases to have an instance
///   that moves during the exposure, no triangle begins or ceases to have an area, and, where materials are one-sided,
///   nothing moves but instances of groups that have BVHs of their own.
/// All else is built anew as a whole: meshes, images, what there is in groups, and which shapes and instances there
/// are. docs/library.md says what each takes.
///
/// Images have the same bits as those of `render(scene, settings)`, whatever was rendered before.
///
/// Of one renderer, functions may be called by one thread at a time, but `stop` by any at any time; several renderers
/// are independent, also of the same scene as long as it is not changed while one of them starts. All but `stop` throw
/// what `render` throws, and InputError where they are called at the wrong time.
class Renderer {
 public:
  /// Settings about reading must be empty: camera, variant, animation, animation_time, shutter and definitions are
  /// LoadOptions. So are strict and frames_per_second, which have no effect here.
  explicit Renderer(const Settings& settings = {});
  ~Renderer();
  /// Of a renderer that was moved from, all functions throw InputError, but `stop`, which does nothing.
  Renderer(Renderer&& other) noexcept;
  Renderer& operator=(Renderer&& other) noexcept;

  const Settings& settings() const;
  /// For the next `start`.
  void set_settings(const Settings& settings);

  /// Begins an image, and drops one that is under way, whose `progress` is called once more. Throws Cancelled if
  /// `progress` returns false or `stop` is called before everything is built; then no image is under way, and the
  /// next `start` builds the scene.
  BuildReport start(const Scene& scene, const ProgressFunction& progress = {});

  /// Takes some samples of every pixel: `samples` rounded up to a multiple of 4, but at most those that are left and 64
  /// (on GPUs 1024), or if that is 0 as many as suit. Returns whether more are to be taken: false at the end, once the
  /// time limit has passed or the noise target is reached, and after `stop`. Time between passes does not count.
  bool render_pass(int64_t samples = 0);

  /// The image so far, with all its layers, not denoised: the mean of the samples of every pixel. Between passes all
  /// pixels have as many, apart from a noise target.
  RenderedImage image() const;
  /// The same with R, G and B denoised by the denoiser of the settings, which must name one (Settings::denoiser). The
  /// samples stay as they are: the image goes on with the bits that it would have without. Where denoising fails, or
  /// `stop` has ended the image, a warning says why and R, G and B are noisy; `denoiser` of the image is then empty.
  RenderedImage denoised_image();
  Progress progress() const;

  /// Ends the pass under way within a few milliseconds; `render_pass` then returns false. A `start` under way ends by
  /// Cancelled before its next step. Without either it has no effect.
  void stop();

  /// Ends an image, after any number of passes: saves its checkpoint, denoises it. Rethrows what `progress` has thrown.
  RenderedImage finish();

  /// Called between passes, on the thread that renders. Returning false stops; an exception does too, and is rethrown.
  using PassFunction = std::function<bool(const Renderer&)>;

  /// All of it: start, passes until there are no more, finish. Where start is cancelled, the image is empty.
  RenderedImage render(const Scene& scene, const ProgressFunction& progress = {}, const PassFunction& after_pass = {});

  /// What was warned of while the scene was built last, and since then by the image; each once. Those of the scene's
  /// reader are Scene::warnings.
  std::vector<Warning> warnings() const;

 private:
  std::unique_ptr<impl::RendererState> state_;
};

}  // namespace ALHAZEN_NAMESPACE

#pragma once

// Renders a scene description with given settings to a film: compiles the scene, then runs passes until all samples are
// taken, the time is up or the render is stopped.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "compile/compile_scene.h"
#include "compile/update_scene.h"
#include "render/denoiser.h"
#include "render/film.h"
#include "render/sample_kernel.h"
#include "render/settings.h"
#include "render/statistics.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// A kernel instead of the one that the settings select, and the BVHs that it traces rays by. Its precision and sampler
/// must be those of the settings.
struct KernelChoice {
  RawKernel kernel = nullptr;
  BvhLayouts layouts;
};

class RenderWatcher;

struct RenderEvents {
  /// Called about ten times a second, and once at the end, from its own thread. Returning false stops the render. So
  /// does an exception, which render_scene rethrows on the thread that called it.
  ProgressFunction progress;
  /// Called before the first sample, when the scene is compiled.
  std::function<void(const RenderStatistics&)> started;
  /// Called between passes, on the thread that called render_scene, if `diagnostics` has a new warning.
  std::function<void()> warned;
  /// Who looks at the image while it grows; null: nobody.
  RenderWatcher* watcher = nullptr;
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
  /// What headers say about its layers (render/image_layers.h).
  std::map<std::string, std::string> layer_metadata() const;
  /// The input of denoisers, from a film that was made for denoising.
  NoisyImage noisy_image() const;
};

/// Looks at an image while it grows, between passes, on the thread that renders. The image has the same bits as
/// without.
class RenderWatcher {
 public:
  virtual ~RenderWatcher() = default;
  /// In how many seconds it wants to look next; 0 or less: at once. The next pass has so many samples that it ends
  /// about then, but at least a block.
  virtual double seconds_to_look() = 0;
  /// Called between two passes once that time is over: the image as it is, not denoised, with the statistics so far.
  /// Not called after the last pass. It counts towards the time limit. What it throws, take_pass throws.
  virtual void look(const Rendering& so_far) = 0;
  /// How long the look took, with all that was done for it.
  virtual void has_looked(double seconds) = 0;
};

/// An image that grows pass by pass. It refers to its SceneRenderer, which renders no other meanwhile.
class GrowingImage {
 public:
  virtual ~GrowingImage() = default;
  /// Takes some samples of every pixel: `samples` rounded up to whole blocks, or if that is 0 as many as suit, in any
  /// case at most those that are left and that a pass of the backend may have. Returns whether more are to be taken:
  /// false at the end, when the time limit has passed and once it is stopped. Throws as render_scene does, but for what
  /// `events` throws.
  virtual bool take_pass(uint32_t samples = 0) = 0;
  /// Ends the pass under way soon. Any thread may call it.
  virtual void stop() = 0;
  virtual Progress progress() = 0;
  /// The image between two passes, not denoised.
  virtual const Rendering& so_far() = 0;
  /// The same, denoised by the denoiser of the settings, which must name one. The samples stay as they are. What
  /// `so_far` has returned is then denoised, too, until it is called again.
  virtual const Rendering& denoised_so_far() = 0;
  /// Ends the render after any number of passes: saves its checkpoint and denoises the image. Throws what `events` has
  /// thrown. Called once, and nothing after it.
  virtual Rendering finish() = 0;
};

/// A scene that is compiled once, and rendered by one camera after another.
class SceneRenderer {
 public:
  virtual ~SceneRenderer() = default;
  /// Renders what the scene's own camera sees, or if one is given, which is in the world, what that sees. Statistics
  /// count the time to read the scene and to build its BVH for the first image only. `preview` replaces the settings
  /// for this image. What is compiled and the backend remain: precision, backend, strategy and device must be the same,
  /// and layers must need no names and light groups that were not asked for before. Throws as render_scene does.
  virtual Rendering render(const RenderEvents& events, const Camera* camera = nullptr,
                           const RenderSettings* preview = nullptr) = 0;
  /// The same, to be rendered pass by pass.
  virtual std::unique_ptr<GrowingImage> begin(const RenderEvents& events, const Camera* camera = nullptr,
                                              const RenderSettings* preview = nullptr) = 0;
  /// Whether render space is the world: then it does not depend on the camera.
  virtual bool is_in_world_space() const = 0;
  /// For the next images: other values of materials and textures, as update_materials does. Returns false where that
  /// does not do.
  virtual bool change_materials(const Scene& description) = 0;
  /// The same for lights and transforms, as update_scene does. Where that returns false, nothing can be rendered.
  virtual bool change_parts(const SceneChanges& changes, const std::vector<Mesh>& meshes, Scene&& outline) = 0;
  /// Makes sure that what lost light there is is known after changes, for an image with such settings; it is warned of
  /// when the image begins. Returns false where all must be compiled anew for it.
  virtual bool find_lost_light(const RenderSettings& settings) = 0;
};

/// Warns of what the settings do not show of the scene. Who makes a renderer need not call it.
void warn_of_settings(const Scene& scene, const RenderSettings& settings, Diagnostics& diagnostics);

/// What a scene is compiled for, beside several cameras.
enum class ForChanges { no, yes };

/// Compiles the scene; `settings` and `diagnostics` must outlive what is returned. Images do not depend on which others
/// were rendered before. Its parts can be changed if it is made for that, which takes more memory. Throws as
/// render_scene does.
std::unique_ptr<SceneRenderer> make_scene_renderer(Scene&& scene, const RenderSettings& settings, double load_seconds,
                                                   Diagnostics& diagnostics, ForChanges for_changes = ForChanges::no);

/// `load_seconds` is the time taken to read the scene, for the statistics. Throws InputError, RenderError,
/// std::bad_alloc, and anything that `events` throws.
Rendering render_scene(Scene&& scene, const RenderSettings& settings, double load_seconds, const RenderEvents& events,
                       Diagnostics& diagnostics);

}  // namespace alhazen::impl

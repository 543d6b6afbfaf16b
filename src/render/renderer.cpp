#include "render/renderer.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <future>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "compile/change_camera.h"
#include "compile/compile_scene.h"
#include "compile/update_materials.h"
#include "compile/update_scene.h"
#include "render/denoiser.h"
#include "render/pass_loop.h"
#include "util/thread_limit.h"

namespace alhazen::impl {

namespace {

/// Counts the pixels that images cannot show: each sample was finite, and their sum is not.
size_t nonfinite_pixels(const Rendering& rendering) {
  if (!rendering.has_samples()) return 0;
  const ImageSource source = rendering.source();
  const auto width = static_cast<size_t>(source.width);
  std::vector<float> row(width * source.channels.size());
  size_t count = 0;
  for (int y = 0; y < source.height; ++y) {
    source.fill_row(y, row);
    for (size_t x = 0; x < width; ++x)
      count += std::isfinite(row[x]) && std::isfinite(row[width + x]) && std::isfinite(row[2 * width + x]) ? 0 : 1;
  }
  return count;
}

using Clock = std::chrono::steady_clock;

/// Refuses what exceeds the machine's memory before rendering.
void check_memory(uint64_t bytes, const std::string& what) {
  const uint64_t memory = static_cast<uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
  if (bytes > memory / 10 * 9)
    throw TooLargeError(what + " takes " + std::to_string(bytes >> 30) + " GiB, and this machine has " +
                        std::to_string(memory >> 30) + ": render parts of it with --crop, or with fewer layers");
}

template <class Real>
std::unique_ptr<Film<Real>> make_film(const RenderSettings& settings, bool weighted) {
  const bool guided = settings.guiding != GuidingMode::off;
  const FilmExtras extras{weighted || guided, settings.asked.noise > 0, !settings.denoiser.empty(), guided,
                          settings.has_alpha};
  const uint64_t bytes = film_bytes<Real>(settings.window, settings.aovs, extras);
  if (settings.denoiser.empty())
    check_memory(bytes, "the image with its layers");
  else
    check_memory(bytes + denoising_bytes(static_cast<uint64_t>(settings.window.pixels())),
                 "the image with its layers, and with denoising,");
  try {
    return std::make_unique<Film<Real>>(settings.window, settings.aovs, extras);
  } catch (const std::bad_alloc&) {
    throw TooLargeError(
        "the image with its layers takes " + std::to_string(bytes >> 20) +
        " MiB, more than is left beside the scene: render parts of it with --crop, or with fewer layers");
  }
}

/// A GPU starts on a thread of its own while the scene is compiled; other backends start when the future is waited for.
std::future<void> start_backend(Backend& backend, const RenderSettings& settings, bool is_on_gpu) try {
  return std::async(is_on_gpu ? std::launch::async : std::launch::deferred, [&] { backend.start(settings); });
} catch (const std::system_error& error) {
  refuse_thread("the thread that starts the GPU", error);
}

void denoise(Rendering& rendering, Diagnostics& diagnostics);

/// The image of one camera. The backend and the scene are the renderer's.
template <class Real>
class GrowingImageOf final : public GrowingImage {
 public:
  /// `rendering` has its settings.
  GrowingImageOf(Backend& backend, CompiledScene<Real>& scene, Rendering&& rendering, const RenderEvents& events,
                 Diagnostics& diagnostics)
      : rendering_(std::move(rendering)), events_(events), diagnostics_(diagnostics) {
    auto film = make_film<Real>(settings(), scene.view.filter.has_negative != 0);
    film->set_scene(LayerScene(scene));
    diagnostics_.activity().begin("rendering");
    if (events_.started) events_.started(rendering_.statistics);
    loop_ = std::make_unique<PassLoop<Real>>(backend, scene, settings(), *film, events_, diagnostics_);
    rendering_.film = std::move(film);
    loop_->begin();
  }

  bool take_pass(uint32_t samples) override {
    const bool goes_on = loop_->take_pass(samples);
    if (goes_on && events_.watcher && events_.watcher->seconds_to_look() <= 0) let_look(*events_.watcher);
    return goes_on;
  }

  void stop() override { loop_->stop(); }

  Progress progress() override { return loop_->progress(); }

  const Rendering& so_far() override {
    forget_denoised();
    loop_->describe(rendering_.statistics);
    return rendering_;
  }

  const Rendering& denoised_so_far() override {
    so_far();
    if (rendering_.has_samples()) denoise(rendering_, diagnostics_);
    return rendering_;
  }

  Rendering finish() override {
    forget_denoised();
    RenderStatistics& statistics = rendering_.statistics;
    loop_->finish(statistics);
    loop_.reset();
    statistics.peak_rss_bytes = peak_rss_bytes();
    if (statistics.nonfinite_samples > 0)
      diagnostics_.warn({statistics.scene}, std::to_string(statistics.nonfinite_samples) +
                                                " samples were infinite or NaN and were counted as black");
    if (!settings().denoiser.empty() && rendering_.has_samples()) denoise(rendering_, diagnostics_);
    if (const size_t pixels = nonfinite_pixels(rendering_); pixels > 0)
      diagnostics_.warn({statistics.scene},
                        std::to_string(pixels) + (pixels == 1 ? " pixel of the image is" : " pixels of the image are") +
                            " infinite or NaN, since the sum of their samples is out of range: scale the lights down, "
                            "by --environment-strength or --light-scale");
    return std::move(rendering_);
  }

 private:
  const RenderSettings& settings() const { return rendering_.statistics.settings; }

  /// The image under way is not denoised, whatever was returned of it.
  void forget_denoised() {
    rendering_.denoised.clear();
    rendering_.statistics.denoiser.clear();
    rendering_.statistics.denoise_seconds = 0;
  }

  void let_look(RenderWatcher& watcher) {
    const Clock::time_point start = Clock::now();
    watcher.look(so_far());
    const double seconds = seconds_since(start);
    loop_->count_look(seconds);
    watcher.has_looked(seconds);
  }

  Rendering rendering_;
  RenderEvents events_;
  Diagnostics& diagnostics_;
  std::unique_ptr<PassLoop<Real>> loop_;
};

/// What a scene is compiled for.
enum class Use { one_image, cameras, changes };

template <class Real>
class RendererOf final : public SceneRenderer {
 public:
  RendererOf(Scene&& scene, const RenderSettings& settings, double load_seconds, Use use,
             const std::optional<KernelChoice>& kernel, Diagnostics& diagnostics)
      : settings_(settings), diagnostics_(diagnostics), scene_name_(scene.name) {
    const Clock::time_point start = Clock::now();
    make_backend();
    CompileOptions options{settings.width, settings.height, build_threads(),
                           kernel ? kernel->layouts : backend_->wanted_layouts(settings)};
    options.texture_budget = settings.texture_budget;
    options.names_objects = wants_names(settings.aovs);
    options.groups_lights = settings.aovs.light_groups;
    options.light_groups = settings.light_groups;
    options.for_cameras = use != Use::one_image;
    options.path_segments = searched_segments(settings);
    if (use == Use::changes) parts_ = std::make_unique<BuiltParts<Real>>();
    flat_ = parts_ ? compile_scene<Real>(std::move(scene), options, diagnostics, *parts_)
                   : compile_scene<Real>(std::move(scene), options, diagnostics);
    started_.get();
    load_seconds_ = load_seconds + seconds_since(start) - flat_.statistics.build_seconds;
    build_seconds_ = flat_.statistics.build_seconds;
  }

  Rendering render(const RenderEvents& events, const Camera* camera, const RenderSettings* preview) override {
    const std::unique_ptr<GrowingImage> image = begin(events, camera, preview);
    while (image->take_pass()) {
    }
    return image->finish();
  }

  std::unique_ptr<GrowingImage> begin(const RenderEvents& events, const Camera* camera,
                                      const RenderSettings* preview) override {
    Rendering rendering;
    RenderStatistics& statistics = rendering.statistics;
    statistics.settings = preview ? *preview : settings_;
    statistics.scene = scene_name_;
    Clock::time_point start = Clock::now();
    if (camera)
      change_camera(*camera, scene_name_, statistics.settings.width, statistics.settings.height, build_threads(),
                    flat_);
    if (parts_)
      for (const Diagnostics::Warning& warning : parts_->lost_light.warnings())
        diagnostics_.warn(warning.where, warning.message);
    set_view(statistics.settings);
    statistics.scene_sizes = flat_.statistics;
    statistics.load_seconds = std::exchange(load_seconds_, 0) + seconds_since(start);
    start = Clock::now();
    prepare_backend();
    statistics.build_seconds = std::exchange(build_seconds_, 0) + seconds_since(start);
    return std::make_unique<GrowingImageOf<Real>>(*backend_, flat_, std::move(rendering), events, diagnostics_);
  }

  bool is_in_world_space() const override { return is_zero(flat_.world_origin); }

  bool change_materials(const Scene& description) override {
    const std::byte* const arena = flat_.arena.get();
    if (!update_materials(description, flat_)) return false;
    knows_lost_light_ = false;
    is_prepared_ = is_prepared_ && flat_.arena.get() == arena;
    return true;
  }

  bool change_parts(const SceneChanges& changes, const std::vector<Mesh>& meshes, Scene&& outline) override {
    const std::byte* const arena = flat_.arena.get();
    if (!parts_ || !update_scene(changes, meshes, std::move(outline), flat_, *parts_)) return false;
    knows_lost_light_ = false;
    is_prepared_ = is_prepared_ && flat_.arena.get() == arena && !changes.transforms;
    return true;
  }

  bool find_lost_light(const RenderSettings& settings) override {
    const uint32_t segments = searched_segments(settings);
    if (!parts_ || (knows_lost_light_ && segments == parts_->options.path_segments)) return true;
    knows_lost_light_ = find_lost_light_again(segments, flat_, *parts_);
    return knows_lost_light_;
  }

 private:
  static uint32_t searched_segments(const RenderSettings& settings) {
    return settings.integrator == IntegratorKind::path ? settings.max_segments : 0;
  }

  bool is_on_gpu() const { return settings_.runs_on_device && settings_.device != host_device; }

  int build_threads() const { return is_on_gpu() ? 0 : settings_.threads; }

  /// A device has a copy of the scene, and other libraries refer to its arrays.
  void prepare_backend() {
    if (is_prepared_ && !(settings_.runs_on_device && prepared_generation_ != flat_.generation)) return;
    is_prepared_ = false;  // also if that fails
    backend_->prepare(flat_);
    is_prepared_ = true;
    prepared_generation_ = flat_.generation;
  }

  /// Sets what integrators read of the settings in the scene.
  void set_view(const RenderSettings& settings) {
    const Real limit = static_cast<Real>(settings.asked.clamp_indirect);
    flat_.view.indirect_limit = limit > 0 ? limit / flat_.view.exposure : Real(0);
    flat_.view.records_through_specular = settings.records_through_specular;
    flat_.view.hides_background = settings.has_alpha;
    flat_.view.sees_through_glass = settings.asked.transparent_glass;
  }

  void make_backend() {
    backend_ = impl::make_backend(settings_.backend);
    if (is_on_gpu()) diagnostics_.activity().begin("starting the GPU");
    started_ = start_backend(*backend_, settings_, is_on_gpu());
  }

  const RenderSettings& settings_;
  Diagnostics& diagnostics_;
  std::string scene_name_;
  CompiledScene<Real> flat_;
  std::unique_ptr<Backend> backend_;
  std::future<void> started_;                ///< waits for the backend, which must outlive it
  std::unique_ptr<BuiltParts<Real>> parts_;  ///< null if it is not for changes
  bool knows_lost_light_ = true;
  bool is_prepared_ = false;                     ///< the backend, for where the arena is
  uint64_t prepared_generation_ = 0;             ///< of the arena
  double load_seconds_ = 0, build_seconds_ = 0;  ///< 0 once an image has counted them
};

}  // namespace

void warn_of_settings(const Scene& scene, const RenderSettings& settings, Diagnostics& diagnostics) {
  if (settings.integrator != IntegratorKind::path)
    for (const Light& light : scene.lights)
      if (!light_traits(light.kind).has_size)
        diagnostics.warn(light.where, "rays cannot hit delta lights: the integrator '" +
                                          to_string(settings.integrator) + "' does not show them; 'path' does");
  if (settings.asked.noise > 0 && settings.samples_per_pixel <= next_decision(0))
    diagnostics.warn({scene.name}, "the noise target has no effect: pixels take " + std::to_string(next_decision(0)) +
                                       " samples before one is finished, and have at most " +
                                       std::to_string(settings.samples_per_pixel) + "; ask for more by --spp");
  if (!settings.denoiser_warning.empty()) diagnostics.warn({scene.name}, settings.denoiser_warning);
}

namespace {

/// Tries the chosen denoiser and, if the choice was left to this program, the next ones until one works. The noisy
/// image is kept if all fail, since it may have taken long to render.
void denoise(Rendering& rendering, Diagnostics& diagnostics) {
  RenderStatistics& statistics = rendering.statistics;
  const RenderSettings& settings = statistics.settings;
  const Clock::time_point start = Clock::now();
  const auto keep_noisy = [&](const std::string& reason) {
    diagnostics.warn({statistics.scene}, "the image was not denoised: " + reason);
  };
  // Who interrupts a render waits for the image, and may not wait long.
  if (statistics.interrupted) return keep_noisy("the render was interrupted");
  const int threads = settings.runs_on_device ? threads_available(static_cast<int>(std::thread::hardware_concurrency()))
                                              : settings.threads;
  const DenoiseOptions options{std::max(0, settings.device), threads};
  const bool may_change = settings.asked.denoiser == "auto";
  for (std::string name = settings.denoiser; !name.empty() && statistics.denoiser.empty();) {
    std::string reason;
    try {
      rendering.denoised = denoise(name, rendering.noisy_image(), options);
      statistics.denoiser = name;
    } catch (const std::bad_alloc&) {
      reason = "out of memory; this machine, or a limit set on it, allows no more";
    } catch (const std::exception& error) {
      reason = error.what();
    }
    const std::string next = reason.empty() || !may_change ? "" : next_denoiser(name);
    if (!next.empty())
      diagnostics.warn({statistics.scene}, "the denoiser '" + name + "' failed, so '" + next + "' is tried: " + reason);
    else if (!reason.empty())
      keep_noisy(reason);
    name = next;
  }
  statistics.denoise_seconds = seconds_since(start);
  statistics.peak_rss_bytes = peak_rss_bytes();
}

std::unique_ptr<SceneRenderer> make_renderer(Scene&& scene, const RenderSettings& settings, double load_seconds,
                                             Use use, const std::optional<KernelChoice>& kernel,
                                             Diagnostics& diagnostics) {
  warn_of_settings(scene, settings, diagnostics);
  if (settings.precision == Precision::single)
    return std::make_unique<RendererOf<float>>(std::move(scene), settings, load_seconds, use, kernel, diagnostics);
  return std::make_unique<RendererOf<double>>(std::move(scene), settings, load_seconds, use, kernel, diagnostics);
}

}  // namespace

std::unique_ptr<SceneRenderer> make_scene_renderer(Scene&& scene, const RenderSettings& settings, double load_seconds,
                                                   Diagnostics& diagnostics, ForChanges for_changes) {
  return make_renderer(std::move(scene), settings, load_seconds,
                       for_changes == ForChanges::yes ? Use::changes : Use::cameras, {}, diagnostics);
}

Rendering render_scene(Scene&& scene, const RenderSettings& settings, double load_seconds, const RenderEvents& events,
                       Diagnostics& diagnostics) {
  return make_renderer(std::move(scene), settings, load_seconds, Use::one_image, events.kernel, diagnostics)
      ->render(events);
}

}  // namespace alhazen::impl

#include "render/renderer.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <future>
#include <limits>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "compile/change_camera.h"
#include "compile/compile_scene.h"
#include "render/backend.h"
#include "render/checkpoint.h"
#include "render/denoiser.h"
#include "render/guiding.h"
#include "render/noise.h"
#include "render/sample_kernel.h"
#include "render/time_limit.h"
#include "util/thread_limit.h"

namespace alhazen::impl {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Reports progress from its own thread, and stops the render if the callback returns false or throws.
class ProgressReporter {
 public:
  ProgressReporter(const ProgressFunction& listener, RenderControl& control) : listener_(listener), control_(control) {
    if (listener_) thread_ = start_thread("the thread that reports progress", [this] { run(); });
  }

  ~ProgressReporter() { finish(); }

  /// Reports progress for the last time. Returns the exception that the callback threw, or null.
  std::exception_ptr finish() {
    if (!thread_.joinable()) return problem_;
    {
      const std::lock_guard lock(mutex_);
      done_ = true;
    }
    wake_.notify_one();
    thread_.join();
    return problem_;
  }

 private:
  /// An exception that leaves a thread ends the process, so it is kept for the rendering thread.
  void run() noexcept try {
    std::unique_lock lock(mutex_);
    while (!wake_.wait_for(lock, std::chrono::milliseconds(100), [this] { return done_; })) tell();
    tell();
  } catch (...) {
    problem_ = std::current_exception();
    control_.stop();
  }

  void tell() {
    Progress p;
    const uint64_t total = control_.samples_total();
    p.samples_done = std::min(control_.samples_done(), total);
    p.samples_total = total;
    p.samples_loaded = control_.samples_loaded();
    p.pixels = control_.pixels();
    p.noise = control_.noise();
    fraction_ = std::max(fraction_, total > 0 ? static_cast<double>(p.samples_done) / static_cast<double>(total) : 1);
    p.fraction = fraction_;
    p.seconds = seconds_since(start_);
    if (!listener_(p)) control_.stop();
  }

  const ProgressFunction& listener_;
  RenderControl& control_;
  double fraction_ = 0;
  Clock::time_point start_ = Clock::now();
  std::mutex mutex_;
  std::condition_variable wake_;
  bool done_ = false;
  std::exception_ptr problem_;  ///< read once the thread has ended
  std::thread thread_;
};

/// The number of samples of the next pass: whole blocks, enough to make the cost of a pass's end negligible, few enough
/// for the image to grow evenly and for a time limit to be kept; at the end the remainder that is no whole block. With
/// a noise target, a pass ends where pixels are decided on. `per_sample` is the time of one sample of every pixel, 0
/// before the first pass, also of a render that is resumed.
uint32_t pass_size(const RenderSettings& settings, uint32_t max_size, uint32_t samples_done, double elapsed,
                   double per_sample) {
  uint32_t left = settings.samples_per_pixel - samples_done;
  if (settings.asked.noise > 0) left = std::min(left, next_decision(samples_done) - samples_done);
  uint32_t size = std::clamp(settings.samples_per_pixel / 16, max_size / 4, max_size);
  if (settings.asked.time_limit > 0) {
    size = samples_per_block;
    if (per_sample > 0) {
      size = static_cast<uint32_t>(std::clamp((settings.asked.time_limit - elapsed) / 8 / std::max(per_sample, 1e-9),
                                              1.0, static_cast<double>(max_size)));
    }
  }
  if (left < samples_per_block) return left;
  size = (size + samples_per_block - 1) / samples_per_block * samples_per_block;
  return std::min(size, left / samples_per_block * samples_per_block);
}

template <class Real>
class PassLoop {
 public:
  PassLoop(Backend& backend, CompiledScene<Real>& scene, const RenderSettings& settings, Film<Real>& film,
           const RenderEvents& events, Diagnostics& diagnostics)
      : backend_(backend),
        scene_(scene),
        settings_(settings),
        film_(film),
        events_(events),
        diagnostics_(diagnostics),
        control_(settings.threads) {
    if (settings.guiding != GuidingMode::off) guiding_.emplace(settings, scene.view);
  }

  void run(RenderStatistics& statistics) {
    if (!settings_.asked.checkpoint.empty()) checkpoint_.emplace(settings_, scene_fingerprint(scene_));
    if (settings_.asked.resume) samples_done_ = checkpoint_->load(film_, guiding_ ? &*guiding_ : nullptr);
    samples_loaded_ = film_.total_samples(samples_done_);
    control_.add_samples(samples_loaded_);
    control_.set_start(static_cast<uint64_t>(settings_.window.pixels()), samples_loaded_);
    set_total();
    std::exception_ptr problem;
    {
      ProgressReporter reporter(events_.progress, control_);
      const TimeLimit limit(settings_.asked.time_limit, control_);
      take_passes();
      if (is_done()) control_.set_total(control_.samples_done());
      problem = reporter.finish();
    }
    save_checkpoint();
    if (problem) std::rethrow_exception(problem);
    if (guiding_) {
      guiding_->weigh_samples(film_);
      statistics.guiding = guiding_->state(samples_done_);
    }
    if (settings_.asked.noise > 0) statistics.noise = noise_state();
    statistics.render_seconds = elapsed_;
    statistics.samples_per_pixel = samples_done_;
    statistics.complete = is_done();
    statistics.mean_samples = static_cast<double>(film_.total_samples(std::numeric_limits<uint32_t>::max())) /
                              static_cast<double>(settings_.window.pixels());
    statistics.interrupted = control_.is_stopped() && !control_.has_reached_limit() && !is_done();
    if (control_.has_reached_limit()) warn_of_gaps();
    statistics.threads = control_.threads();
    for (const ThreadStatistics& thread : control_.threads()) {
      statistics.camera_samples += thread.samples;
      statistics.rays += thread.rays;
      statistics.shadow_rays += thread.shadow_rays;
      statistics.nonfinite_samples += thread.nonfinite_samples;
      statistics.counters.add(thread.counters);
    }
  }

 private:
  void take_passes() {
    Clock::time_point saved = Clock::now();
    double last_pass_per_sample = 0;
    while (!is_done() && !control_.is_stopped()) {
      uint32_t size =
          pass_size(settings_, backend_.max_samples_per_pass(), samples_done_, elapsed_, seconds_per_sample());
      if (guiding_) size = std::min(size, guiding_->samples_left(samples_done_));
      if (settings_.asked.time_limit > 0 && last_pass_per_sample > 0 &&
          elapsed_ + last_pass_per_sample * size + estimate_seconds_ > settings_.asked.time_limit)
        return;
      if (size % samples_per_block != 0) {
        save_checkpoint();
        in_whole_blocks_ = false;
      }
      const Clock::time_point start = Clock::now();
      if (guiding_) guiding_->begin_pass(film_, samples_done_);
      const IntegratorKind integrator = guiding_ ? guiding_->integrator() : settings_.integrator;
      if (guiding_) scene_.view.guide = guiding_->view();
      backend_.render_pass(RenderPass<Real>{scene_, kernel_of(integrator), settings_, film_, control_, samples_done_,
                                            size, integrator, guiding_ ? &*guiding_ : nullptr});
      const double seconds = seconds_since(start);
      elapsed_ += seconds;
      has_current_state_ = false;
      if (control_.is_stopped() && !film_.has_samples(samples_done_ + size)) return;
      last_pass_per_sample = seconds / size;
      samples_done_ += size;
      if (settings_.asked.noise > 0 && next_decision(samples_done_ - 1) == samples_done_)
        last_pass_per_sample *= finish_pixels();
      if (seconds_since(saved) >= settings_.asked.checkpoint_seconds) {
        save_checkpoint();
        saved = Clock::now();
      }
    }
  }

  SampleKernel<Real> kernel_of(IntegratorKind integrator) const {
    return events_.kernel ? SampleKernel<Real>(events_.kernel->kernel)
                          : select_sample_kernel<Real>(integrator, settings_.sampler);
  }

  bool is_done() const { return samples_done_ == settings_.samples_per_pixel || unfinished_ == 0; }

  /// How long one sample of every pixel that is not finished takes, by the samples taken so far; 0 if none were.
  double seconds_per_sample() const {
    const uint64_t taken = control_.samples_done() - samples_loaded_;
    return taken > 0 ? elapsed_ / static_cast<double>(taken) * static_cast<double>(unfinished_) : 0;
  }

  /// Estimates the error of the film as it is, finishes pixels if `finishes`, and returns whether there was memory to
  /// do so. Rendering goes on without: every pixel that is not finished then takes more samples.
  bool estimate_noise(bool finishes) {
    const Clock::time_point start = Clock::now();
    bool is_known = true;
    try {
      if (guiding_) guiding_->weigh_samples(film_);
      const NoiseEstimate<Real> estimate(settings_, film_);
      if (finishes) estimate.finish_pixels();
      state_ = estimate.state();
    } catch (const std::bad_alloc&) {
      is_known = false;
      state_ = unknown_noise(film_);
      warn({}, "no memory was left to estimate the noise: no pixels are finished by it, and the render continues");
    }
    control_.set_noise(is_known ? state_.noise : 0);
    has_current_state_ = true;
    estimate_seconds_ = seconds_since(start);
    elapsed_ += estimate_seconds_;
    return is_known;
  }

  /// Returns the fraction of the pixels that are left of those that were not finished before.
  double finish_pixels() {
    if (!estimate_noise(true)) return 1;
    const double before = static_cast<double>(unfinished_);
    unfinished_ = film_.unfinished();
    control_.set_total(static_cast<uint64_t>(state_.expected_samples));
    return static_cast<double>(unfinished_) / before;
  }

  const NoiseState& noise_state() {
    if (!has_current_state_) estimate_noise(false);
    return state_;
  }

  void set_total() {
    const uint64_t pixels = static_cast<uint64_t>(settings_.window.pixels());
    unfinished_ = film_.unfinished();
    const bool is_estimated = settings_.asked.noise > 0 && samples_done_ >= next_decision(0) && estimate_noise(false);
    control_.set_total(is_estimated ? static_cast<uint64_t>(state_.expected_samples)
                                    : pixels * settings_.samples_per_pixel);
  }

  /// Nothing is saved once the film contains a partial block: the sums of a longer render would be rounded differently.
  /// The image is kept even if its state cannot be saved.
  void save_checkpoint() {
    if (!checkpoint_ || !in_whole_blocks_) return;
    try {
      checkpoint_->save(film_, samples_done_, guiding_ ? &*guiding_ : nullptr);
    } catch (const std::exception& failure) {
      warn({settings_.asked.checkpoint},
           std::string("the checkpoint was not saved, and the render continues: ") + failure.what());
    }
  }

  /// After a time limit that has ended the first pass.
  void warn_of_gaps() {
    const uint64_t pixels = static_cast<uint64_t>(settings_.window.pixels()), empty = film_.pixels_without_samples();
    if (empty == 0 || empty == pixels) return;
    warn({}, "the time limit passed before every pixel had a sample: " +
                 std::to_string((100 * empty + pixels - 1) / pixels) +
                 " percent of them have none and are black; give a longer one, or a smaller --size");
  }

  void warn(const SourceLocation& where, const std::string& message) {
    const size_t before = diagnostics_.warnings().size();
    diagnostics_.warn(where, message);
    if (events_.warned && diagnostics_.warnings().size() > before) events_.warned();
  }

  Backend& backend_;
  CompiledScene<Real>& scene_;
  std::optional<Guiding<Real>> guiding_;
  const RenderSettings& settings_;
  Film<Real>& film_;
  const RenderEvents& events_;
  Diagnostics& diagnostics_;
  RenderControl control_;
  std::optional<CheckpointFile> checkpoint_;
  uint32_t samples_done_ = 0;  ///< in every pixel
  uint64_t unfinished_ = 0;    ///< pixels
  bool in_whole_blocks_ = true;
  double elapsed_ = 0;              ///< seconds of taking samples and of deciding on pixels, in this run
  uint64_t samples_loaded_ = 0;     ///< of all pixels together, from the checkpoint
  NoiseState state_;                ///< of the last estimate
  bool has_current_state_ = false;  ///< whether no samples were taken since
  double estimate_seconds_ = 0;     ///< what the last estimate took
};

/// Refuses what exceeds the machine's memory before rendering.
void check_memory(uint64_t bytes, const std::string& what) {
  const uint64_t memory = static_cast<uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
  if (bytes > memory / 10 * 9)
    throw InputError(what + " takes " + std::to_string(bytes >> 30) + " GiB, and this machine has " +
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
    throw InputError("the image with its layers takes " + std::to_string(bytes >> 20) +
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

template <class Real>
class RendererOf final : public SceneRenderer {
 public:
  RendererOf(Scene&& scene, const RenderSettings& settings, double load_seconds, bool for_cameras,
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
    options.for_cameras = for_cameras;
    options.path_segments = settings.integrator == IntegratorKind::path ? settings.max_segments : 0;
    flat_ = compile_scene<Real>(std::move(scene), options, diagnostics);
    if (settings.asked.clamp_indirect > 0)
      flat_.view.indirect_limit = static_cast<Real>(settings.asked.clamp_indirect) / flat_.view.exposure;
    flat_.view.records_through_specular = settings.records_through_specular;
    flat_.view.hides_background = settings.has_alpha;
    flat_.view.sees_through_glass = settings.asked.transparent_glass;
    started_.get();
    load_seconds_ = load_seconds + seconds_since(start) - flat_.statistics.build_seconds;
    build_seconds_ = flat_.statistics.build_seconds;
  }

  Rendering render(const RenderEvents& events, const Camera* camera, const RenderSettings* preview) override {
    const RenderSettings& settings = preview ? *preview : settings_;
    Rendering rendering;
    RenderStatistics& statistics = rendering.statistics;
    statistics.settings = settings;
    statistics.scene = scene_name_;
    Clock::time_point start = Clock::now();
    if (camera) {
      change_camera(*camera, scene_name_, settings.width, settings.height, build_threads(), flat_);
      // A device has a copy of the scene.
      if (settings_.runs_on_device && is_prepared_) {
        make_backend();
        started_.get();
        is_prepared_ = false;
      }
    }
    statistics.scene_sizes = flat_.statistics;
    statistics.load_seconds = std::exchange(load_seconds_, 0) + seconds_since(start);
    start = Clock::now();
    if (!is_prepared_) backend_->prepare(flat_);
    is_prepared_ = true;
    statistics.build_seconds = std::exchange(build_seconds_, 0) + seconds_since(start);
    auto film = make_film<Real>(settings, flat_.view.filter.has_negative != 0);
    film->set_scene(LayerScene(flat_));
    diagnostics_.activity().begin("rendering");
    if (events.started) events.started(statistics);
    PassLoop<Real>(*backend_, flat_, settings, *film, events, diagnostics_).run(statistics);
    statistics.peak_rss_bytes = peak_rss_bytes();
    if (statistics.nonfinite_samples > 0)
      diagnostics_.warn({statistics.scene}, std::to_string(statistics.nonfinite_samples) +
                                                " samples were infinite or NaN and were counted as black");
    rendering.film = std::move(film);
    if (!settings.denoiser.empty() && rendering.has_samples()) denoise(rendering, diagnostics_);
    return rendering;
  }

 private:
  bool is_on_gpu() const { return settings_.runs_on_device && settings_.device != host_device; }

  int build_threads() const { return is_on_gpu() ? 0 : settings_.threads; }

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
  std::future<void> started_;  ///< waits for the backend, which must outlive it
  bool is_prepared_ = false;
  double load_seconds_ = 0, build_seconds_ = 0;  ///< 0 once an image has counted them
};

}  // namespace

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

/// Warns of what the settings do not show of the scene.
void check_settings(const Scene& scene, const RenderSettings& settings, Diagnostics& diagnostics) {
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

std::unique_ptr<SceneRenderer> make_renderer(Scene&& scene, const RenderSettings& settings, double load_seconds,
                                             bool for_cameras, const std::optional<KernelChoice>& kernel,
                                             Diagnostics& diagnostics) {
  check_settings(scene, settings, diagnostics);
  if (settings.precision == Precision::single)
    return std::make_unique<RendererOf<float>>(std::move(scene), settings, load_seconds, for_cameras, kernel,
                                               diagnostics);
  return std::make_unique<RendererOf<double>>(std::move(scene), settings, load_seconds, for_cameras, kernel,
                                              diagnostics);
}

}  // namespace

std::unique_ptr<SceneRenderer> make_scene_renderer(Scene&& scene, const RenderSettings& settings, double load_seconds,
                                                   Diagnostics& diagnostics) {
  return make_renderer(std::move(scene), settings, load_seconds, true, {}, diagnostics);
}

Rendering render_scene(Scene&& scene, const RenderSettings& settings, double load_seconds, const RenderEvents& events,
                       Diagnostics& diagnostics) {
  return make_renderer(std::move(scene), settings, load_seconds, false, events.kernel, diagnostics)->render(events);
}

}  // namespace alhazen::impl

#pragma once

// Takes the samples of an image, pass by pass, until there are enough, the time is up or the render is stopped.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>
#include <string>

#include "render/backend.h"
#include "render/checkpoint.h"
#include "render/guiding.h"
#include "render/noise.h"
#include "render/progress_reporter.h"
#include "render/renderer.h"
#include "render/time_limit.h"

namespace alhazen::impl {

inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The number of samples of the next pass: whole blocks, enough to make the cost of a pass's end negligible, few enough
/// for the image to grow evenly and for a time limit to be kept; at the end the remainder that is no whole block. With
/// a noise target, a pass ends where pixels are decided on. `wanted`, if not 0, is how many there should be.
/// `per_sample` is the time of one sample of every pixel, 0 before the first pass, also of a render that is resumed. If
/// nobody waits for the end of the pass, `longest` is infinite, else it is how many seconds it should take at most.
inline uint32_t pass_size(const RenderSettings& settings, uint32_t max_size, uint32_t wanted, uint32_t samples_done,
                          double elapsed, double per_sample, double longest = std::numeric_limits<double>::infinity()) {
  uint32_t left = settings.samples_per_pixel - samples_done;
  if (settings.asked.noise > 0) left = std::min(left, next_decision(samples_done) - samples_done);
  uint32_t size = std::clamp(settings.samples_per_pixel / 16, max_size / 4, max_size);
  if (wanted > 0) {
    size = std::min(wanted, max_size);
  } else if (settings.asked.time_limit > 0) {
    size = samples_per_block;
    if (per_sample > 0) {
      size = static_cast<uint32_t>(std::clamp((settings.asked.time_limit - elapsed) / 8 / std::max(per_sample, 1e-9),
                                              1.0, static_cast<double>(max_size)));
    }
  }
  if (wanted == 0 && std::isfinite(longest))
    size = per_sample > 0 ? static_cast<uint32_t>(std::clamp(longest / per_sample, 1.0, static_cast<double>(size)))
                          : samples_per_block;
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

  /// Loads the checkpoint, if there is one, and starts the clocks. Call it first.
  void begin() {
    if (!settings_.asked.checkpoint.empty()) checkpoint_.emplace(settings_, scene_fingerprint(scene_));
    if (settings_.asked.resume) samples_done_ = checkpoint_->load(film_, guiding_ ? &*guiding_ : nullptr);
    samples_loaded_ = film_.total_samples(samples_done_);
    control_.add_samples(samples_loaded_);
    control_.set_start(static_cast<uint64_t>(settings_.window.pixels()), samples_loaded_);
    set_total();
    saved_ = Clock::now();
    reporter_.emplace(events_.progress, control_);
  }

  /// Takes the samples of one pass: `wanted` in whole blocks, or as many as suit if it is 0. Returns whether another
  /// may follow.
  bool take_pass(uint32_t wanted) {
    if (is_done() || control_.is_stopped()) return false;
    const Clock::time_point start = Clock::now();
    const double limit = settings_.asked.time_limit;
    // What a caller does between passes does not count.
    const TimeLimit time_limit(limit > 0 ? std::max(limit - active_, 1e-9) : 0, control_);
    const bool goes_on = !control_.is_stopped() && take_next_pass(wanted);
    active_ += seconds_since(start);
    return goes_on;
  }

  /// Counts the time of a look at the image, which is part of the render, towards its limit.
  void count_look(double seconds) { active_ += seconds; }

  /// Ends the render after any number of passes. Rethrows what a callback has thrown.
  void finish(RenderStatistics& statistics) {
    if (is_done()) control_.set_total(control_.samples_done());
    const std::exception_ptr problem = reporter_->finish();
    reporter_.reset();
    save_checkpoint();
    if (problem) std::rethrow_exception(problem);
    describe(statistics);
    if (control_.has_reached_limit()) warn_of_gaps();
  }

  void stop() { control_.stop(); }

  Progress progress() {
    const Progress now = progress_of(control_, elapsed_, fraction_);
    fraction_ = now.fraction;
    return now;
  }

  /// Sets what is known of the samples so far.
  void describe(RenderStatistics& statistics) {
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
    statistics.threads = control_.threads();
    statistics.camera_samples = statistics.rays = statistics.shadow_rays = statistics.nonfinite_samples = 0;
    statistics.counters = {};
    for (const ThreadStatistics& thread : control_.threads()) {
      statistics.camera_samples += thread.samples;
      statistics.rays += thread.rays;
      statistics.shadow_rays += thread.shadow_rays;
      statistics.nonfinite_samples += thread.nonfinite_samples;
      statistics.counters.add(thread.counters);
    }
  }

 private:
  using Clock = std::chrono::steady_clock;

  /// Returns whether another may follow.
  bool take_next_pass(uint32_t wanted) {
    const double longest =
        events_.watcher ? events_.watcher->seconds_to_look() : std::numeric_limits<double>::infinity();
    uint32_t size = pass_size(settings_, backend_.max_samples_per_pass(), wanted, samples_done_, active_,
                              seconds_per_sample(), longest);
    if (guiding_) size = std::min(size, guiding_->samples_left(samples_done_));
    if (settings_.asked.time_limit > 0 && last_pass_per_sample_ > 0 &&
        active_ + last_pass_per_sample_ * size + estimate_seconds_ > settings_.asked.time_limit)
      return false;
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
    if (control_.is_stopped() && !film_.has_samples(samples_done_ + size)) return false;
    last_pass_per_sample_ = seconds / size;
    samples_done_ += size;
    if (settings_.asked.noise > 0 && next_decision(samples_done_ - 1) == samples_done_)
      last_pass_per_sample_ *= finish_pixels();
    if (seconds_since(saved_) >= settings_.asked.checkpoint_seconds) {
      save_checkpoint();
      saved_ = Clock::now();
    }
    return !is_done();
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
  double elapsed_ = 0;               ///< seconds of taking samples and of deciding on pixels, in this run
  uint64_t samples_loaded_ = 0;      ///< of all pixels together, from the checkpoint
  NoiseState state_;                 ///< of the last estimate
  bool has_current_state_ = false;   ///< whether no samples were taken since
  double estimate_seconds_ = 0;      ///< what the last estimate took
  double last_pass_per_sample_ = 0;  ///< seconds
  Clock::time_point saved_;          ///< when the last checkpoint was
  std::optional<ProgressReporter> reporter_;
  double active_ = 0;    ///< seconds in take_pass
  double fraction_ = 0;  ///< that was told last
};

}  // namespace alhazen::impl

#pragma once

// State shared with a running render: its progress, the request to stop, and statistics of each thread.

#include <atomic>
#include <cstdint>
#include <vector>

#include "core/integrators/sample_counters.h"

namespace alhazen::impl {

/// Statistics of one thread, on cache lines of their own.
struct alignas(128) ThreadStatistics {
  uint64_t samples = 0;
  uint64_t rays = 0;  ///< closest-hit rays
  uint64_t shadow_rays = 0;
  uint64_t nonfinite_samples = 0;  ///< samples that were NaN or infinite and counted as black
  double busy_seconds = 0;
  double processor_seconds = 0;  ///< of the busy time, what the thread ran on a processor; 0: not measured
  SampleCounters counters;       ///< zero in builds that do not count
};

class RenderControl {
 public:
  explicit RenderControl(int threads) : threads_(static_cast<size_t>(threads)) {}

  ThreadStatistics& thread(int index) { return threads_[static_cast<size_t>(index)]; }
  const std::vector<ThreadStatistics>& threads() const { return threads_; }

  void add_samples(uint64_t count) { samples_done_.fetch_add(count, std::memory_order_relaxed); }
  uint64_t samples_done() const { return samples_done_.load(std::memory_order_relaxed); }

  /// Samples of all pixels together that the render takes, as far as is known.
  void set_total(uint64_t count) { samples_total_.store(count, std::memory_order_relaxed); }
  uint64_t samples_total() const { return samples_total_.load(std::memory_order_relaxed); }

  /// Called before the render is watched: the pixels of the image, and the samples that a checkpoint held.
  void set_start(uint64_t pixels, uint64_t samples_loaded) {
    pixels_ = pixels;
    samples_loaded_ = samples_loaded;
  }
  uint64_t pixels() const { return pixels_; }
  uint64_t samples_loaded() const { return samples_loaded_; }

  /// The estimated error of the image; 0: not known.
  void set_noise(double noise) { noise_.store(noise, std::memory_order_relaxed); }
  double noise() const { return noise_.load(std::memory_order_relaxed); }

  /// Asks the backend to return soon; pixels that it has not begun remain as they are.
  void stop() { stopped_.store(true, std::memory_order_relaxed); }
  bool is_stopped() const { return stopped_.load(std::memory_order_relaxed); }

  /// Stops because the time limit has passed, unless the render is stopped already.
  void stop_at_limit() {
    if (!stopped_.exchange(true)) reached_limit_.store(true);
  }
  bool has_reached_limit() const { return reached_limit_.load(std::memory_order_relaxed); }

 private:
  std::vector<ThreadStatistics> threads_;
  uint64_t pixels_ = 0, samples_loaded_ = 0;
  std::atomic<uint64_t> samples_done_{0}, samples_total_{0};
  std::atomic<double> noise_{0};
  std::atomic<bool> stopped_{false}, reached_limit_{false};
};

}  // namespace alhazen::impl

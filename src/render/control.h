#pragma once

// What runs beside the rendering: how far it is, whether to stop, what each thread did.

#include <atomic>
#include <cstdint>
#include <vector>

namespace alhazen {

/// What one thread did. Each on cache lines of its own.
struct alignas(128) ThreadStatistics {
  uint64_t samples = 0;
  uint64_t rays = 0;  ///< closest-hit rays
  uint64_t shadow_rays = 0;
  uint64_t nonfinite_samples = 0;  ///< samples that came out NaN or infinite and were counted as black
  double busy_seconds = 0;
};

class RenderControl {
 public:
  explicit RenderControl(int threads) : threads_(static_cast<size_t>(threads)) {}

  ThreadStatistics& thread(int index) { return threads_[static_cast<size_t>(index)]; }
  const std::vector<ThreadStatistics>& threads() const { return threads_; }

  void add_samples(uint64_t count) { samples_done_.fetch_add(count, std::memory_order_relaxed); }
  uint64_t samples_done() const { return samples_done_.load(std::memory_order_relaxed); }

  /// Asks the backend to come back soon; pixels that it has not begun stay as they are.
  void stop() { stopped_.store(true, std::memory_order_relaxed); }
  bool is_stopped() const { return stopped_.load(std::memory_order_relaxed); }

 private:
  std::vector<ThreadStatistics> threads_;
  std::atomic<uint64_t> samples_done_{0};
  std::atomic<bool> stopped_{false};
};

}  // namespace alhazen

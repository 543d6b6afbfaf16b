#pragma once

// The time limit of a render.

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "render/control.h"
#include "util/thread_limit.h"

namespace alhazen::impl {

/// Stops a render when its time is over, also in the middle of a pass.
class TimeLimit {
 public:
  /// Without a limit if `seconds` is 0.
  TimeLimit(double seconds, RenderControl& control) {
    if (seconds == 0) return;
    const std::chrono::steady_clock::time_point end =
        std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                                               std::chrono::duration<double>(std::min(seconds, longest_limit)));
    if (end <= std::chrono::steady_clock::now()) {
      control.stop_at_limit();
      return;
    }
    thread_ = start_thread("the thread that keeps the time limit", [this, end, &control] {
      std::unique_lock lock(mutex_);
      if (!wake_.wait_until(lock, end, [this] { return is_over_; })) control.stop_at_limit();
    });
  }

  ~TimeLimit() {
    if (!thread_.joinable()) return;
    {
      const std::lock_guard lock(mutex_);
      is_over_ = true;
    }
    wake_.notify_one();
    thread_.join();
  }

  TimeLimit(const TimeLimit&) = delete;
  TimeLimit& operator=(const TimeLimit&) = delete;

 private:
  static constexpr double longest_limit = 1e9;  ///< seconds; a clock cannot count to any number

  std::mutex mutex_;
  std::condition_variable wake_;
  bool is_over_ = false;
  std::thread thread_;
};

}  // namespace alhazen::impl

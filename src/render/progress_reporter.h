#pragma once

// Tells a caller how far a render is.

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "alhazen/alhazen.h"
#include "render/control.h"

namespace alhazen::impl {

/// Reports progress from its own thread, and stops the render if the callback returns false or throws. Without a
/// callback it does nothing. Both references must outlive it.
class ProgressReporter {
 public:
  ProgressReporter(const ProgressFunction& listener, RenderControl& control);
  ~ProgressReporter() { finish(); }
  ProgressReporter(const ProgressReporter&) = delete;
  ProgressReporter& operator=(const ProgressReporter&) = delete;

  /// Reports progress for the last time. Returns the exception that the callback threw, or null.
  std::exception_ptr finish();

 private:
  using Clock = std::chrono::steady_clock;

  void run() noexcept;
  void tell();

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

/// What a render has done. `fraction` is not less than `fraction_before`.
Progress progress_of(const RenderControl& control, double seconds, double fraction_before);

}  // namespace alhazen::impl

#pragma once

// Progress and cancellation while a scene is read or built.

#include <atomic>
#include <chrono>
#include <exception>
#include <optional>

#include "alhazen/alhazen.h"
#include "api/caller_errors.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

/// The progress function of a caller. What it throws reaches the caller as it is.
class Listener {
 public:
  explicit Listener(const ProgressFunction& progress) : progress_(progress) {}
  // Functions that it has given refer to it.
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  /// Tells of the steps of a task from now on. Where the function returns false, the step throws Cancelled.
  void watch(Activity& activity);

  /// The next step throws Cancelled. Any thread may call it.
  void cancel() { is_cancelled_ = true; }

  bool has_thrown() const { return thrown_ != nullptr; }

  /// For the render that follows; empty if the caller has given none.
  ProgressFunction function();

  /// Returns what `work` returns. Throws as for_caller does, but what the function has thrown remains as it is.
  template <class Work>
  auto for_caller(Work&& work) -> decltype(std::forward<Work>(work)()) {
    try {
      return std::forward<Work>(work)();
    } catch (...) {
      if (thrown_) std::rethrow_exception(thrown_);  // whatever has become of it on its way
      rethrow_to_caller();
    }
  }

 private:
  using Clock = std::chrono::steady_clock;

  bool tell(const Progress& progress);
  void tell_step(const char* what);

  ProgressFunction progress_;
  std::exception_ptr thrown_;  ///< by the function
  std::atomic<bool> is_cancelled_{false};
  Clock::time_point start_ = Clock::now();
  std::optional<Clock::time_point> told_;
};

}  // namespace alhazen::impl

#include "render/progress_reporter.h"

#include <algorithm>

#include "util/thread_limit.h"

namespace alhazen::impl {

Progress progress_of(const RenderControl& control, double seconds, double fraction_before) {
  Progress p;
  const uint64_t total = control.samples_total();
  p.samples_done = std::min(control.samples_done(), total);
  p.samples_total = total;
  p.samples_loaded = control.samples_loaded();
  p.pixels = control.pixels();
  p.noise = control.noise();
  p.fraction =
      std::max(fraction_before, total > 0 ? static_cast<double>(p.samples_done) / static_cast<double>(total) : 1);
  p.seconds = seconds;
  return p;
}

ProgressReporter::ProgressReporter(const ProgressFunction& listener, RenderControl& control)
    : listener_(listener), control_(control) {
  if (listener_) thread_ = start_thread("the thread that reports progress", [this] { run(); });
}

std::exception_ptr ProgressReporter::finish() {
  if (!thread_.joinable()) return problem_;
  {
    const std::lock_guard lock(mutex_);
    done_ = true;
  }
  wake_.notify_one();
  thread_.join();
  return problem_;
}

/// An exception that leaves a thread ends the process, so it is kept for the rendering thread.
void ProgressReporter::run() noexcept try {
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, std::chrono::milliseconds(100), [this] { return done_; })) tell();
  tell();
} catch (...) {
  problem_ = std::current_exception();
  control_.stop();
}

void ProgressReporter::tell() {
  const Progress p = progress_of(control_, std::chrono::duration<double>(Clock::now() - start_).count(), fraction_);
  fraction_ = p.fraction;
  if (!listener_(p)) control_.stop();
}

}  // namespace alhazen::impl

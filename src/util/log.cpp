#include "util/log.h"

#include <atomic>
#include <mutex>
#include <utility>

namespace alhazen::impl {

namespace {

struct Listener {
  std::mutex mutex;
  LogFunction function;
  std::atomic<bool> is_set{false};
};

/// Never destroyed: threads may log while the process ends.
Listener& listener() {
  static Listener& only = *new Listener;
  return only;
}

}  // namespace

bool is_logged() { return listener().is_set.load(std::memory_order_relaxed); }

void log_line(LogLevel level, const std::string& line) noexcept try {
  if (!is_logged()) return;
  Listener& to = listener();
  const std::lock_guard lock(to.mutex);
  if (to.function) to.function(level, line);
} catch (...) {
  // A log that fails must not end the work.
}

}  // namespace alhazen::impl

namespace ALHAZEN_NAMESPACE {

void set_log(LogFunction log) {
  impl::Listener& to = impl::listener();
  const std::lock_guard lock(to.mutex);
  to.is_set = static_cast<bool>(log);
  to.function = std::move(log);
}

}  // namespace ALHAZEN_NAMESPACE

#include "api/building.h"

#include <string_view>

namespace alhazen::impl {

namespace {

constexpr std::chrono::milliseconds between_calls{100};

}  // namespace

bool Listener::tell(const Progress& progress) {
  try {
    return progress_(progress);
  } catch (...) {
    thrown_ = std::current_exception();
    throw;
  }
}

void Listener::tell_step(const char* what) {
  if (is_cancelled_) throw Cancelled("cancelled while the scene was built");
  if (!progress_ || std::string_view(what) == "rendering") return;  // which tells by itself
  const Clock::time_point now = Clock::now();
  if (told_ && now - *told_ < between_calls) return;
  told_ = now;
  Progress progress;
  progress.activity = what;
  progress.seconds = std::chrono::duration<double>(now - start_).count();
  if (!tell(progress)) throw Cancelled("cancelled by the progress function");
}

void Listener::watch(Activity& activity) {
  activity.watch([this](const char* what) { tell_step(what); });
}

ProgressFunction Listener::function() {
  if (!progress_) return {};
  return [this](const Progress& progress) { return tell(progress); };
}

}  // namespace alhazen::impl

#pragma once

// What a task that takes long is doing, for whoever waits for it.

#include <atomic>
#include <cstdint>
#include <functional>
#include <utility>

#include "util/log.h"

namespace alhazen::impl {

/// Set by the thread that does the task, read by any. Copies have the state, and nobody who watches it.
class Activity {
 public:
  Activity() = default;
  Activity(const Activity& other) { *this = other; }
  Activity& operator=(const Activity& other) {
    set(other.state());
    return *this;
  }

  struct State {
    const char* what = "";  ///< "reading textures"; empty: nothing yet
    uint64_t part = 0;      ///< the number of the part that is done now, from 1; 0: there are none
    uint64_t total = 0;     ///< parts; 0: not known
  };

  /// `what` is a text that is never freed. Throws what a watcher throws.
  void begin(const char* what, uint64_t part = 0, uint64_t total = 0) {
    if (is_logged() && what != what_) log_line(LogLevel::info, what);
    set({what, part, total});
    if (watcher_) watcher_(what);
  }
  State state() const { return {what_, part_, total_}; }

  /// Calls `watcher` for all that begins, on the thread that does the task. It ends the task by throwing.
  void watch(std::function<void(const char* what)> watcher) { watcher_ = std::move(watcher); }

 private:
  void set(const State& state) {
    part_ = state.part;
    total_ = state.total;
    what_ = state.what;
  }

  std::atomic<const char*> what_{""};
  std::atomic<uint64_t> part_{0}, total_{0};
  std::function<void(const char*)> watcher_;
};

}  // namespace alhazen::impl

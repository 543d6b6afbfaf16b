#pragma once

// What a task that takes long is doing, for whoever waits for it.

#include <atomic>
#include <cstdint>

namespace alhazen::impl {

/// Set by the thread that does the task, read by any.
class Activity {
 public:
  Activity() = default;
  Activity(const Activity& other) { *this = other; }
  Activity& operator=(const Activity& other) {
    const State now = other.state();
    begin(now.what, now.part, now.total);
    return *this;
  }

  struct State {
    const char* what = "";  ///< "reading textures"; empty: nothing yet
    uint64_t part = 0;      ///< the number of the part that is done now, from 1; 0: there are none
    uint64_t total = 0;     ///< parts; 0: not known
  };

  /// `what` is a text that is never freed.
  void begin(const char* what, uint64_t part = 0, uint64_t total = 0) {
    part_ = part;
    total_ = total;
    what_ = what;
  }
  State state() const { return {what_, part_, total_}; }

 private:
  std::atomic<const char*> what_{""};
  std::atomic<uint64_t> part_{0}, total_{0};
};

}  // namespace alhazen::impl

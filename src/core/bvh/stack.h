#pragma once

// Where a walk through a tree keeps what it has yet to visit. On a CPU that is an array of the thread; on a GPU its
// first entries lie in shared memory (backends/cuda/device_thread.cuh).

#include "core/math/platform.h"

namespace ALHAZEN_CORE {

/// A stack of at most `capacity` entries, which the caller knows to be enough.
template <class Entry, int capacity>
class LocalStack {
 public:
  // Not initialised: most of it is never used.
  ALHAZEN_HD LocalStack() {}  // NOLINT

  ALHAZEN_HD int height() const { return height_; }
  ALHAZEN_HD void push(const Entry& entry) { entries_[height_++] = entry; }
  ALHAZEN_HD Entry pop() { return entries_[--height_]; }

 private:
  int height_ = 0;
  Entry entries_[capacity];
};

/// Makes the stacks of one thread, one at a time.
struct LocalStacks {
  template <class Entry, int capacity>
  ALHAZEN_HD LocalStack<Entry, capacity> make() const {
    return {};
  }
};

}  // namespace ALHAZEN_CORE

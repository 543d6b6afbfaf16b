#pragma once

// The traversal stack. On a CPU it is a local array; on a GPU its first entries are in shared memory
// (backends/cuda/module/device_thread.cuh).

#include <concepts>
#include <cstdint>

#include "core/math/platform.h"

namespace ALHAZEN_CORE {

template <class Stack, class Entry>
concept TraversalStack = requires(Stack& stack, const Stack& unchanged, const Entry& entry) {
  { unchanged.height() } -> std::same_as<int>;
  stack.push(entry);
  { stack.pop() } -> std::same_as<Entry>;
};

/// Makes the stacks of one thread, one at a time, with `make<Entry, capacity>()`. The caller guarantees that the
/// capacity suffices.
template <class Maker>
concept StackMaker = requires(const Maker& stacks) {
  { stacks.template make<uint32_t, 64>() } -> TraversalStack<uint32_t>;
};

/// A stack of at most `capacity` entries.
template <class Entry, int capacity>
class LocalStack {
 public:
  // The entries stay uninitialised, since most are never used.
  ALHAZEN_HD LocalStack() {}  // NOLINT

  ALHAZEN_HD int height() const { return height_; }
  ALHAZEN_HD void push(const Entry& entry) { entries_[height_++] = entry; }
  ALHAZEN_HD Entry pop() { return entries_[--height_]; }

 private:
  int height_ = 0;
  Entry entries_[capacity];
};

struct LocalStacks {
  template <class Entry, int capacity>
  ALHAZEN_HD LocalStack<Entry, capacity> make() const {
    return {};
  }
};
static_assert(StackMaker<LocalStacks>);

}  // namespace ALHAZEN_CORE

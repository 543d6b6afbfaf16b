#pragma once

// What leaves the public interface: failures to allocate become OutOfMemoryError.

#include <utility>

namespace alhazen::impl {

/// To be called while an exception is handled: throws OutOfMemoryError in the place of std::bad_alloc and
/// std::length_error, and rethrows all others.
[[noreturn]] void rethrow_to_caller();

/// Returns what `work` returns.
template <class Work>
auto for_caller(Work&& work) -> decltype(std::forward<Work>(work)()) {
  try {
    return std::forward<Work>(work)();
  } catch (...) {
    rethrow_to_caller();
  }
}

}  // namespace alhazen::impl

#pragma once

// The stack of the program.

#include <functional>

namespace alhazen::impl {

/// Calls `body` and returns its result: on this thread if its stack may grow enough (ulimit -s and -v), else on a
/// thread with enough stack. `body` must not throw.
int run_on_enough_stack(const std::function<int()>& body);

}  // namespace alhazen::impl

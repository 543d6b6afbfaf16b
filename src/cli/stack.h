#pragma once

// The stack that the program runs on.

#include <functional>

namespace alhazen {

/// Calls `body` and returns what it returns: here where the stack may grow to what the program needs, else (ulimit -s)
/// on a thread that has it. An exception must not leave `body`.
int run_on_enough_stack(const std::function<int()>& body);

}  // namespace alhazen

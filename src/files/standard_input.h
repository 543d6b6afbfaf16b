#pragma once

// A scene on standard input.

#include <string>

namespace alhazen::impl {

/// All of standard input, read when it is first asked for. Throws InputError if it is a terminal, is empty, cannot be
/// read, or is larger than the memory that is left.
const std::string& standard_input();

}  // namespace alhazen::impl

#pragma once

// Messages for the function that a program has set by alhazen::set_log.

#include <string>

#include "alhazen/log.h"

namespace alhazen::impl {

/// Whether a program listens, so that texts need to be made.
bool is_logged();

/// Never throws.
void log_line(LogLevel level, const std::string& line) noexcept;

}  // namespace alhazen::impl

#pragma once

// Messages for the function that a program has set by alhazen::set_log.

#include <string>

#include "alhazen/log.h"

namespace alhazen::impl {

/// Whether a program listens, so that texts need to be made.
bool is_logged();

/// As alhazen::set_log, with lines as the command line would word them.
void set_log_function(LogFunction log);

/// Never throws.
void log_line(LogLevel level, const std::string& line) noexcept;

}  // namespace alhazen::impl

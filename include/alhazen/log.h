#pragma once

// Messages of the library while it works, for the log of the program that embeds it.

#include <functional>
#include <string>

#include "alhazen/version.h"

namespace ALHAZEN_NAMESPACE {

enum class LogLevel {
  info,     ///< what is being done now, such as "reading textures"
  warning,  ///< Warning::text() of a warning, as soon as it is found; images and scenes have all of theirs, too
};

/// Gets one line without its end. It may be called by any thread that works for the library, but by one at a time. It
/// must not call set_log; what it throws is ignored.
using LogFunction = std::function<void(LogLevel, const std::string& line)>;

/// Sends the messages of the whole process to `log` from now on; an empty function, as at the start, drops them. Errors
/// are thrown and never logged. The library itself writes nothing to standard output or standard error, which belong to
/// the program. Any thread may call it at any time; once it returns, the function before is not called any more.
void set_log(LogFunction log);

}  // namespace ALHAZEN_NAMESPACE

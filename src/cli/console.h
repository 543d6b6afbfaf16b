#pragma once

// What the program says, on stdout and stderr. Nothing here throws: a stream that is closed, full or a pipe without a
// reader must not end a render that may have taken days.

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

namespace alhazen {

/// To be called before anything is opened. Closed standard streams are opened where writing fails, so that no picture
/// gets their numbers and with it what is meant for them. Writing to a pipe without a reader or beyond the limit on the
/// size of files becomes an error of that write instead of the end of the program.
void prepare_streams();

/// Writes to stderr. What it does not take is lost: where it takes nothing for two seconds, a reader that has stopped
/// reading, nothing more is waited for.
void tell_text(std::string_view text);
/// The same for what may as well be left out, progress: nothing is waited for.
void tell_progress(std::string_view text);

template <class... Arguments>
void tell(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  tell_text(fmt::format(format, std::forward<Arguments>(arguments)...));
}

/// Keeps text for stdout, which flush_output() writes.
void print_text(std::string_view text);

template <class... Arguments>
void print_out(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  print_text(fmt::format(format, std::forward<Arguments>(arguments)...));
}

/// Writes what was printed. Empty, or why not all of it was written.
std::string flush_output();

}  // namespace alhazen

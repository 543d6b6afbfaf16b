#pragma once

// Output to stdout and stderr. Nothing here throws: a closed or full stream, or a pipe without a reader, must not end a
// render that may have taken days.

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

namespace alhazen::impl {

/// Call this before any file is opened. It opens closed standard streams such that writing fails, so that no image gets
/// their descriptors and the messages for them. Writing to a pipe without a reader or beyond the file size limit
/// becomes an error of that write instead of ending the program.
void prepare_streams();

/// Writes to stderr. If it accepts nothing for two seconds, because its reader has stopped, the rest is dropped.
void tell_text(std::string_view text);
/// The same for dispensable text, such as progress: it never waits.
void tell_progress(std::string_view text);

template <class... Arguments>
void tell(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  tell_text(fmt::format(format, std::forward<Arguments>(arguments)...));
}

/// Stores text for stdout, which flush_output() writes.
void print_text(std::string_view text);

template <class... Arguments>
void print_out(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  print_text(fmt::format(format, std::forward<Arguments>(arguments)...));
}

/// Writes the stored text. Returns why not all of it was written, or an empty string.
std::string flush_output();

}  // namespace alhazen::impl

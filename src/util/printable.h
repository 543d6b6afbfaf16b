#pragma once

// Makes text from files and command lines safe to print on a terminal.

#include <string>
#include <string_view>

namespace alhazen::impl {

/// Returns `text` on one line without anything that acts on a terminal: control characters (C0, DEL, C1), line breaks,
/// invisible characters and those that change the writing direction, and invalid UTF-8 bytes become visible escapes
/// such as \x1b and \u202e. Letters of every script are kept. The function is idempotent.
std::string printable(std::string_view text);

/// The same for several lines: line feeds are kept.
std::string printable_lines(std::string_view text);

/// The same with each such character replaced by one '?' (a tab by a blank), so that columns can be counted.
/// `columns` receives the number of characters of the result.
std::string printable_columns(std::string_view text, size_t& columns);

}  // namespace alhazen::impl

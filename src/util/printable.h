#pragma once

// Text from files and command lines as a terminal may show it.

#include <string>
#include <string_view>

namespace alhazen {

/// `text` on one line, without anything that a terminal acts upon: control characters (C0, DEL, C1), line breaks,
/// characters that turn the direction of writing or cannot be seen, and bytes that are not UTF-8 become visible
/// escapes such as \x1b and \u202e. Letters of every script stay. Applied twice it changes nothing more.
std::string printable(std::string_view text);

/// The same of several lines: line feeds stay.
std::string printable_lines(std::string_view text);

/// The same with each such character replaced by one '?' (a tab by a blank), so that columns stay countable.
/// `columns` receives how many characters the result has.
std::string printable_columns(std::string_view text, size_t& columns);

}  // namespace alhazen

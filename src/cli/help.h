#pragma once

// The text of --help and --help-all.

#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace alhazen::impl {

/// Lines are at most this long, and --help of a subcommand has at most `max_help_lines` of them: two screens.
inline constexpr size_t help_columns = 80, max_help_lines = 80;

/// Marks an option as one that --help lists.
void mark_common(const CLI::Option& option);

/// The first clauses of a description, as many as fit into so many characters, and at least one. A colon ends one if
/// need be.
std::string shortened(const std::string& description, size_t room);

/// The help of a subcommand, or of the program, which is called `name` on the command line. Where options are marked
/// as common, `all` is needed for the others, and for the whole of long descriptions; where none is, all of them are
/// listed.
std::string help_text(const CLI::App& app, const std::string& name, bool all);

}  // namespace alhazen::impl

#pragma once

// Files of options for --config: one a line, `name = value`, in the part of TOML that options need.

#include <string>
#include <vector>

#include "util/diagnostics.h"

namespace alhazen::impl {

/// A line of the file.
struct FileOption {
  std::string name;                 ///< with the section before a dot, but for [render] and [default]
  std::vector<std::string> values;  ///< more than one of an array; "true" where the name stands alone
  SourceLocation where;
};

/// Reads `name = value`, `name = "value"`, `name = [1, 2]`, and `name` for true, under [section] or none; # begins a
/// comment. A value without quotes ends before a comment, and commas or spaces in it make it an array. Throws
/// InputError with the line if it is anything else, or if a value is missing.
std::vector<FileOption> read_option_file(const std::string& path);

}  // namespace alhazen::impl

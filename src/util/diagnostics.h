#pragma once

// How the library reports to its caller: bad input by an error, which stops it, or by warnings, which are reported
// once; and what it is doing.

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "alhazen/error.h"
#include "alhazen/warning.h"
#include "util/activity.h"

namespace alhazen::impl {

/// A position in a file. Lines and columns count from 1; 0 means unknown.
struct SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;

  /// `file:line:column`, without unknown parts.
  std::string to_string() const;
};

/// Input that cannot be used: a malformed or missing file, or a setting out of range. `what()` is one complete message:
/// `file:line:column: what is wrong and what to do`, followed by an excerpt if there is one. It contains nothing that
/// acts on a terminal (util/printable.h), whatever names the input contains. The command line exits with code 2.
class InputError : public alhazen::InputError {
 public:
  explicit InputError(const std::string& message);
  InputError(const SourceLocation& where, const std::string& message, const std::string& excerpt = {});
};

/// What a setting asks for and this build or this machine does not have. The command line exits with code 2.
class UnsupportedError : public alhazen::UnsupportedError {
 public:
  explicit UnsupportedError(const std::string& message);
};

/// Input that is too large for the memory of this machine, refused before it is used up or once it is. The command line
/// exits with code 2.
class TooLargeError : public OutOfMemoryError {
 public:
  explicit TooLargeError(const std::string& message);
  TooLargeError(const SourceLocation& where, const std::string& message);
};

/// A failure while the program runs, such as a full disk. The command line exits with code 1, as for every other Error.
class RenderError : public Error {
 public:
  explicit RenderError(const std::string& message);
};

/// Collects warnings, and knows what is being done. Each text is kept once, with the location of its first occurrence.
class Diagnostics {
 public:
  struct Warning {
    SourceLocation where;
    std::string message;
    std::string to_string() const;  ///< one printable line
    alhazen::Warning to_public() const;
  };

  void warn(const SourceLocation& where, const std::string& message);
  const std::vector<Warning>& warnings() const { return warnings_; }
  std::vector<alhazen::Warning> public_warnings() const;
  Activity& activity() { return activity_; }

 private:
  std::vector<Warning> warnings_;
  std::set<std::string> seen_;
  Activity activity_;
};

}  // namespace alhazen::impl

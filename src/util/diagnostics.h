#pragma once

// How the library speaks of bad input: one error that stops, and warnings that are told once.

#include <cstddef>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace alhazen {

/// A place in a file. Lines and columns count from 1; 0 means that the part is not known.
struct SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;

  /// `file:line:column`, leaving out what is not known.
  std::string to_string() const;
};

/// Input that cannot be used: a malformed file, a missing one, a setting out of range.
/// `what()` is one complete message: `file:line:column: what is wrong and what to do`, with the excerpt below it
/// where there is one. Nothing in it acts on a terminal (util/printable.h), whatever names the input holds.
/// The command line turns it into exit code 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message);
  InputError(const SourceLocation& where, const std::string& message, const std::string& excerpt = {});
};

/// Something that failed while the machine was at work: a full disk, no memory. Exit code 1.
class RenderError : public std::runtime_error {
 public:
  explicit RenderError(const std::string& message);
};

/// Collects warnings. The same text is kept once, however often and wherever it comes up; the place is the first.
class Diagnostics {
 public:
  struct Warning {
    SourceLocation where;
    std::string message;
    std::string to_string() const;  ///< one printable line
  };

  void warn(const SourceLocation& where, const std::string& message);
  const std::vector<Warning>& warnings() const { return warnings_; }

 private:
  std::vector<Warning> warnings_;
  std::set<std::string> seen_;
};

}  // namespace alhazen

#pragma once

// What the library throws.

#include <memory>
#include <stdexcept>
#include <string>

#include "alhazen/version.h"

namespace ALHAZEN_NAMESPACE {

/// Any failure that the library reports: `what()` is one complete message for a person.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message);
};

/// Input that cannot be used: a malformed or missing file, a setting or an argument out of range. `what()` begins with
/// `file:line:column: ` where there is a file, and names the argument where there is none.
class InputError : public Error {
 public:
  /// Of an argument or a setting.
  explicit InputError(const std::string& message);
  /// Of a file. `what` is the whole text; lines and columns count from 1, and 0 means unknown.
  InputError(const std::string& what, const std::string& message, const std::string& file, int line, int column);

  const std::string& message() const { return place_->message; }  ///< without the place
  const std::string& file() const { return place_->file; }        ///< empty if there is none
  int line() const { return place_->line; }                       ///< 0 if there is none
  int column() const { return place_->column; }                   ///< 0 if there is none

 private:
  struct Place {
    std::string message, file;
    int line = 0, column = 0;
  };
  std::shared_ptr<const Place> place_;  ///< shared, so that copying an exception never throws
};

}  // namespace ALHAZEN_NAMESPACE

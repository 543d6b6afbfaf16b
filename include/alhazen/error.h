#pragma once

// What the library throws: one class for each kind of failure, all of them alhazen::Error. Besides these, callers see
// only what their own callbacks throw, and std::bad_alloc where so little memory is left that small parts of a scene
// cannot be added.

#include <memory>
#include <stdexcept>
#include <string>

#include "alhazen/version.h"

namespace ALHAZEN_NAMESPACE {

/// Any failure that the library reports: `what()` is one complete message for a person. It is of this class itself if
/// it is of none of those below, such as a file that cannot be written or a thread that the system refuses.
class Error : public std::runtime_error {
 public:
  explicit Error(const std::string& message);
};

/// Input that cannot be used: a malformed or missing file, what a file asks for and Alhazen does not have, a setting or
/// an argument out of range. `what()` begins with `file:line:column: ` where there is a file, and names the argument or
/// setting where there is none.
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

/// A setting asks for what this build or this machine does not have: a backend whose module is not installed, a GPU
/// where there is none or whose driver is too old, a denoiser without its library. Other settings may work.
class UnsupportedError : public Error {
 public:
  using Error::Error;
};

/// The memory of this machine or of its GPU, or a limit set on it, does not suffice: for a scene, for an image with its
/// layers, or for arrays that are added to a scene. Of a file, `what()` begins with its name. Where allocation fails
/// within the library, callers get this, and no std::bad_alloc (from which it cannot be derived as well: a class with
/// two bases of std::exception is not caught as std::exception).
class OutOfMemoryError : public Error {
 public:
  using Error::Error;
};

/// A GPU, or a library that drives it, has failed while it worked. The process may not be able to use it any more.
class DeviceError : public Error {
 public:
  using Error::Error;
};

/// A progress function has returned false before there was an image: while Scene::load reads, RayQueries are built, or
/// Renderer::start builds a scene. Renders do not throw it, but return the image so far.
class Cancelled : public Error {
 public:
  using Error::Error;
};

}  // namespace ALHAZEN_NAMESPACE

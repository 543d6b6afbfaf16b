#include "files/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>
#include <stdexcept>
#include <utility>

#include "util/diagnostics.h"

namespace alhazen::impl {

namespace {

int open_path(const InputPath& path, int flags) {
  return path.scope.confinement ? path.scope.confinement->open(path.name, flags | O_CLOEXEC)
                                : ::open(path.name.c_str(), flags | O_CLOEXEC);
}

std::string opening_problem(int error) {
  if (error == EXDEV)
    return "is outside the scene's folder, or an absolute symbolic link leads to it, and reading is confined to that "
           "folder (--confine): put the file into it, make the link relative, or read without the confinement";
  return std::string("cannot be opened: ") + std::strerror(error);
}

/// Why a file of that kind is not read; empty for regular files.
std::string kind_problem(mode_t mode) {
  if (S_ISREG(mode)) return {};
  if (S_ISDIR(mode)) return "is a folder; give the name of a file";
  const char* kind = S_ISFIFO(mode) ? "a pipe" : S_ISSOCK(mode) ? "a socket" : "a device";
  return std::string("is ") + kind + ", not a regular file; copy its bytes into a file and give that";
}

/// Returns the descriptor, or -1 with `problem` set.
int open_regular(const InputPath& path, struct stat& status, InputProblem& result) {
  std::string& problem = result.message;
  if (path.name.empty() || path.name.find('\0') != std::string::npos) {
    problem = path.name.empty() ? "no file is named" : "the name of the file holds a zero byte";
    return -1;
  }
  // The name is only looked up first: opening a device or a pipe would already have an effect.
  const int found = open_path(path, O_PATH);
  if (found < 0) {
    result.is_missing = errno == ENOENT || errno == ENOTDIR;
    problem = opening_problem(errno);
    return -1;
  }
  const bool is_known = ::fstat(found, &status) == 0;
  ::close(found);
  problem = is_known ? kind_problem(status.st_mode) : "has a kind that cannot be determined";
  if (!problem.empty()) return -1;
  // Something else may have the name by now; it is opened without blocking and checked again.
  const int descriptor = open_path(path, O_RDONLY | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) {
    problem = opening_problem(errno);
    return -1;
  }
  problem = ::fstat(descriptor, &status) == 0 ? kind_problem(status.st_mode) : "has a kind that cannot be determined";
  if (problem.empty()) return descriptor;
  ::close(descriptor);
  return -1;
}

}  // namespace

InputFile::InputFile(const InputPath& path) : name_(path.name) {
  struct stat status = {};
  InputProblem problem;
  descriptor_ = open_regular(path, status, problem);
  if (descriptor_ < 0) throw InputError({name_}, problem.message);
  size_ = static_cast<uint64_t>(std::max<off_t>(status.st_size, 0));
  identity_ = {static_cast<uint64_t>(status.st_dev), static_cast<uint64_t>(status.st_ino)};
  if (path.scope.record) path.scope.record->add(identity_, name_);
}

InputFile::~InputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

InputFile::InputFile(InputFile&& other) noexcept
    : name_(std::move(other.name_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      size_(other.size_),
      identity_(other.identity_) {}

size_t InputFile::read(void* into, size_t capacity) {
  while (true) {
    const ssize_t count = ::read(descriptor_, into, std::min(capacity, size_t{1} << 30));
    if (count >= 0) return static_cast<size_t>(count);
    if (errno != EINTR) throw InputError({name_}, std::string("cannot be read: ") + std::strerror(errno));
  }
}

std::vector<uint8_t> InputFile::read_all() {
  try {
    std::vector<uint8_t> bytes(size_);
    size_t filled = 0;
    while (filled < bytes.size()) {
      const size_t count = read(bytes.data() + filled, bytes.size() - filled);
      if (count == 0) throw InputError({name_}, "cannot be read to its end; it was truncated meanwhile");
      filled += count;
    }
    return bytes;
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  throw TooLargeError(
      {name_}, "the file of " + std::to_string(size_ >> 20) + " MiB is too large for the memory of this machine");
}

std::vector<uint8_t> read_short_text(const InputPath& path) {
  InputFile file(path);
  if (file.size() > uint64_t{1} << 20) throw InputError({path.name}, "has over 1 MiB; a table of numbers is expected");
  return file.read_all();
}

InputProblem input_problem(const InputPath& path) {
  struct stat status = {};
  InputProblem problem;
  const int descriptor = open_regular(path, status, problem);
  if (descriptor >= 0) ::close(descriptor);
  return problem;
}

}  // namespace alhazen::impl

#include "io/images/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "scene/diagnostics.h"

namespace alhazen {

namespace {

const char* remedy(int error) {
  switch (error) {
    case ENOENT:
      return ": create the folder first";
    case ENOTDIR:
      return ": a part of the path is a file; choose another path";
    case EISDIR:
      return ": give the name of a file in it";
    case EACCES:
    case EPERM:
    case EROFS:
      return ": choose a folder that you may write to";
    case ENOSPC:
    case EDQUOT:
      return ": free some space or choose another disk";
    case ENAMETOOLONG:
      return ": choose a shorter name";
    default:
      return "";
  }
}

std::string write_error_message(const std::string& path, int error) {
  return "cannot write " + path + ": " + std::generic_category().message(error) + remedy(error);
}

[[noreturn]] void throw_write_error(const std::string& path, int error) {
  throw RenderError(write_error_message(path, error));
}

/// Where a write to `path` ends up. A link is followed, so that the rename replaces the file and not the link.
std::string resolve(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::is_symlink(path, ignored)) return path;
  const std::filesystem::path resolved = std::filesystem::weakly_canonical(path, ignored);
  return ignored ? path : resolved.string();
}

/// A name that no other process and no other thread of this one picks. Short, so that the longest of file names still
/// has a temporary beside it.
std::string temporary_name() {
  static std::atomic<unsigned> counter{0};
  const auto ticks = std::chrono::steady_clock::now().time_since_epoch().count();
  return ".alhazen-" + std::to_string(::getpid()) + "-" + std::to_string(ticks) + "-" +
         std::to_string(counter.fetch_add(1)) + ".tmp";
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path) : path_(path), target_(resolve(path)) {
  if (path.empty()) throw RenderError("cannot write a picture without a file name: give one");
  struct stat existing = {};
  const bool exists = ::stat(target_.c_str(), &existing) == 0;
  if (exists && S_ISDIR(existing.st_mode)) throw_write_error(path_, EISDIR);
  if (exists && !S_ISREG(existing.st_mode)) {
    descriptor_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) throw_write_error(path_, errno);
    return;
  }
  if (exists && ::access(target_.c_str(), W_OK) != 0) throw_write_error(path_, errno);
  create_temporary();
  // A picture that replaces another keeps its permissions; a new one has those of the umask. A filesystem that cannot
  // keep permissions is no reason to fail.
  if (exists && ::fchmod(descriptor_, existing.st_mode & 0777) != 0) errno = 0;
}

void AtomicFile::create_temporary() {
  const std::filesystem::path folder = std::filesystem::path(target_).parent_path();
  do {
    temporary_ = (folder / temporary_name()).string();
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (descriptor_ < 0 && errno == EEXIST);
  if (descriptor_ < 0) throw_write_error(path_, errno);
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::write(const void* data, size_t size) {
  const char* bytes = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::write(descriptor_, bytes, std::min(size, size_t{1} << 30));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail(written < 0 ? errno : EIO);
    bytes += written;
    size -= static_cast<size_t>(written);
    position_ += static_cast<uint64_t>(written);
  }
}

void AtomicFile::seek(uint64_t position) {
  if (::lseek(descriptor_, static_cast<off_t>(position), SEEK_SET) < 0) fail(errno);
  position_ = position;
}

void AtomicFile::commit() {
  if (failed()) throw RenderError(failure_);
  // Devices and some network filesystems cannot sync and say so; what they have taken is as safe as they make it.
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS && errno != ENOTSUP) fail(errno);
  const int closed = ::close(descriptor_);
  descriptor_ = -1;
  if (closed != 0 && errno != EINTR) fail(errno);
  if (temporary_.empty()) return;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  temporary_.clear();
}

void AtomicFile::fail(int error) {
  if (failure_.empty()) failure_ = write_error_message(path_, error);
  throw RenderError(failure_);
}

}  // namespace alhazen

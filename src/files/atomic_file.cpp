#include "files/atomic_file.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <climits>
#include <cstdio>
#include <cstring>
#include <system_error>
#include <thread>

#include "files/file_identity.h"
#include "files/temporary_files.h"

namespace alhazen::impl {

namespace {

using Clock = std::chrono::steady_clock;

std::atomic<bool (*)()> pipe_wait_is_over{nullptr};

constexpr const char* standard_output = "-";

constexpr auto pipe_poll_interval = std::chrono::milliseconds(50);
constexpr auto pipe_patience = std::chrono::seconds(1);

/// Number of names to try for a temporary file. A process searches for abandoned files only once, so few are removed.
constexpr int max_temporaries = 16;

/// Returns whether a wait that began at `since` has lasted long enough after a request to end.
bool is_enough(Clock::time_point since) {
  bool (*const is_over)() = pipe_wait_is_over.load();
  return is_over && is_over() && Clock::now() - since >= pipe_patience;
}

const char* remedy(int error) {
  switch (error) {
    case ENOTDIR:
      return "a part of the path is a file: choose another path";
    case EISDIR:
      return "this is a folder: give the name of a file";
    case ENOENT:
      return "the folder does not exist: create it first";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a file and a folder that you may write to";
    case ENOSPC:
    case EDQUOT:
      return "free some space or choose another disk";
    case EFBIG:
      return "raise the limit on the size of files (ulimit -f)";
    case ENAMETOOLONG:
      return "choose a shorter name";
    case ELOOP:
      return "its symbolic links lead in a circle: choose another name";
    case EPIPE:
      return "nobody reads from this pipe: start its reader first";
    default:
      return "";
  }
}

/// The new name survives a power failure only after its folder is synced. It is not an error if the filesystem cannot
/// sync folders.
void sync_folder(const std::string& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

std::string path_of_descriptor(int descriptor) { return "/proc/self/fd/" + std::to_string(descriptor); }

}  // namespace

WriteError::WriteError(const std::string& path, int error)
    : RenderError("cannot write " + path + ": " + reason(error)), error_(error) {}

std::string WriteError::reason(int error) {
  const std::string cause = std::generic_category().message(error), advice = remedy(error);
  return advice.empty() ? cause : cause + ": " + advice;
}

void set_pipe_wait_is_over(bool (*is_over)()) { pipe_wait_is_over.store(is_over); }

AtomicFile::AtomicFile(const std::string& path) : path_(path == standard_output ? "to standard output" : path) {
  if (path.empty()) throw RenderError("cannot write a file without a name: give one");
  if (path == standard_output) {
    is_pipe_ = true;
    target_ = path;
    return;
  }
  int error = 0;
  target_ = follow_links(path, error);
  if (error != 0) throw WriteError(path_, error);
  struct stat existing = {};
  const bool exists = ::stat(target_.c_str(), &existing) == 0;
  if (!exists && errno != ENOENT) throw WriteError(path_, errno);
  if (exists && S_ISDIR(existing.st_mode)) throw WriteError(path_, EISDIR);
  if (exists && ::access(target_.c_str(), W_OK) != 0) throw WriteError(path_, errno);
  is_pipe_ = exists && S_ISFIFO(existing.st_mode);
  replaces_ = !exists || S_ISREG(existing.st_mode);
  if (is_pipe_) return;
  if (!replaces_) {
    descriptor_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
    if (descriptor_ < 0) throw WriteError(path_, errno);
    return;
  }
  create_temporary();
  if (exists) keep_owner_and_permissions(existing);
}

/// Otherwise a new file would get the permissions of the umask. It is not an error if the filesystem cannot store them
/// or the user may not change owners.
void AtomicFile::keep_owner_and_permissions(const struct stat& existing) {
  const int owned = ::fchown(descriptor_, existing.st_uid, existing.st_gid);
  const int permitted = ::fchmod(descriptor_, existing.st_mode & 0777);
  if (owned != 0 || permitted != 0) errno = 0;
}

void AtomicFile::create_temporary() {
  const std::string folder = folder_of_path(target_);
  remove_abandoned_temporaries(folder);
  descriptor_ = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
  // Without /proc the file could not be given a name.
  if (descriptor_ >= 0 && ::access(path_of_descriptor(descriptor_).c_str(), F_OK) == 0) {
    lock_temporary(descriptor_);
    return;
  }
  if (descriptor_ >= 0) ::close(descriptor_);
  create_named_temporary();
}

void AtomicFile::create_named_temporary() {
  const std::string folder = folder_of_path(target_);
  int error = 0;
  for (int i = 0; i < max_temporaries; ++i) {
    temporary_ = temporary_path(folder);
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0) {
      error = errno;
      if (error == EEXIST) continue;
      break;
    }
    // Between open and lock another process may have considered the file abandoned and removed it. Names are never
    // reused, so while a file of this name exists, it is ours. Inode numbers would not tell, since some network and
    // user-space filesystems change them.
    if (lock_temporary(descriptor_) && ::access(temporary_.c_str(), F_OK) == 0) return;
    error = errno;
    ::close(descriptor_);
    ::unlink(temporary_.c_str());
  }
  descriptor_ = -1;
  temporary_.clear();
  throw WriteError(path_, error);
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::write(const void* data, size_t size) {
  const char* bytes = static_cast<const char*>(data);
  if (is_pipe_) {
    if (for_pipe_.size() < position_ + size) for_pipe_.resize(position_ + size);
    if (size > 0) std::memcpy(for_pipe_.data() + position_, bytes, size);
    position_ += size;
    return;
  }
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
  if (!is_pipe_ && ::lseek(descriptor_, static_cast<off_t>(position), SEEK_SET) < 0) fail(errno);
  position_ = position;
}

void AtomicFile::commit() {
  if (failed()) throw WriteError(path_, failure_);
  if (is_pipe_) write_pipe();
  // Devices and some network filesystems cannot sync and report it; what they accepted is as safe as they make it.
  if (::fsync(descriptor_) != 0 && errno != EINVAL && errno != EROFS && errno != ENOTSUP) fail(errno);
  if (!replaces_) return close_or_fail();
  // Network filesystems report some errors only on close. The descriptor itself stays open for its lock.
  if (const int copy = ::dup(descriptor_); copy >= 0 && ::close(copy) != 0 && errno != EINTR) fail(errno);
  if (temporary_.empty()) give_name();
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  temporary_.clear();
  sync_folder(folder_of_path(target_));
  ::close(descriptor_);
  descriptor_ = -1;
}

void AtomicFile::give_name() {
  const std::string source = path_of_descriptor(descriptor_), folder = folder_of_path(target_);
  std::string name;
  do {
    name = temporary_path(folder);
    if (::linkat(AT_FDCWD, source.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0) {
      temporary_ = name;
      return;
    }
  } while (errno == EEXIST);
  fail(errno);
}

/// A pipe is opened and written without blocking, so that the write can be abandoned if there is no reader.
void AtomicFile::write_pipe() {
  Clock::time_point since = Clock::now();
  const bool is_standard = target_ == standard_output;
  if (is_standard && (descriptor_ = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0)) < 0) fail(errno);
  while (!is_standard && (descriptor_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK)) < 0) {
    if (errno != ENXIO && errno != EINTR) fail(errno);
    if (is_enough(since)) fail(EPIPE);
    std::this_thread::sleep_for(pipe_poll_interval);
  }
  // Standard output may block; where a pipe has room it takes this many bytes at once.
  const size_t piece = is_standard ? PIPE_BUF : for_pipe_.size();
  for (size_t sent = 0; sent < for_pipe_.size();) {
    pollfd ready{descriptor_, POLLOUT, 0};
    const bool has_room = !is_standard || ::poll(&ready, 1, 0) > 0;
    const ssize_t written =
        has_room ? ::write(descriptor_, for_pipe_.data() + sent, std::min(piece, for_pipe_.size() - sent)) : 0;
    if (written > 0) {
      sent += static_cast<size_t>(written);
      since = Clock::now();
      continue;
    }
    if (written < 0 && errno != EAGAIN && errno != EINTR) fail(errno);
    if (is_enough(since)) fail(EPIPE);
    pollfd room{descriptor_, POLLOUT, 0};
    ::poll(&room, 1, static_cast<int>(pipe_poll_interval.count()));
  }
}

void AtomicFile::close_or_fail() {
  const int closed = ::close(descriptor_);
  descriptor_ = -1;
  if (closed != 0 && errno != EINTR) fail(errno);
}

void AtomicFile::fail(int error) {
  if (failure_ == 0) failure_ = error;
  throw WriteError(path_, failure_);
}

void check_target(const std::string& path) {
  try {
    const AtomicFile probe(path);
  } catch (const WriteError& failure) {
    if (failure.error() != ENOSPC && failure.error() != EDQUOT)
      throw InputError({path}, "cannot be written: " + WriteError::reason(failure.error()));
  }
}

}  // namespace alhazen::impl

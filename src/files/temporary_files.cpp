#include "files/temporary_files.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <mutex>
#include <set>

namespace alhazen::impl {

namespace {

namespace fs = std::filesystem;

constexpr const char *prefix = ".alhazen.", *suffix = ".tmp";

/// Returns whether this is the first search of a folder.
bool is_first_look(const std::string& folder) {
  static std::mutex mutex;
  static std::set<std::string> seen;
  const std::lock_guard lock(mutex);
  return seen.insert(folder).second;
}

void remove_if_abandoned(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor < 0) return;
  struct stat file = {};
  const bool is_ours = ::fstat(descriptor, &file) == 0 && S_ISREG(file.st_mode) && file.st_uid == ::geteuid();
  if (is_ours && ::flock(descriptor, LOCK_EX | LOCK_NB) == 0) ::unlink(path.c_str());
  ::close(descriptor);
}

}  // namespace

std::string temporary_path(const std::string& folder) {
  static std::atomic<unsigned> counter{0};
  const auto ticks = std::chrono::steady_clock::now().time_since_epoch().count();
  const std::string name =
      std::to_string(::getpid()) + "-" + std::to_string(ticks) + "-" + std::to_string(counter.fetch_add(1));
  return (fs::path(folder) / (prefix + name + suffix)).string();
}

bool lock_temporary(int descriptor) {
  // On a filesystem without locks nobody can take the file from us either.
  return ::flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

void remove_abandoned_temporaries(const std::string& folder) {
  if (!is_first_look(folder)) return;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    if (name.starts_with(prefix) && name.ends_with(suffix)) remove_if_abandoned(at->path().string());
  }
}

}  // namespace alhazen::impl

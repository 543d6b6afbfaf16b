#include "files/confinement.h"

#include <fcntl.h>
#include <linux/openat2.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>

#include "util/diagnostics.h"

namespace alhazen::impl {

namespace {

/// The path of an open file; empty if the system does not tell.
std::string path_of(int descriptor) {
  std::error_code error;
  const auto place = std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(descriptor), error);
  return error ? std::string() : place.string();
}

/// The part of `path` below `folder`; nothing if it does not begin with it. The path is not resolved here.
std::optional<std::string> below(const std::string& folder, const std::string& path) {
  if (folder.empty()) return path.starts_with('/') ? std::nullopt : std::optional(path);
  const std::string prefix = folder.ends_with('/') ? folder : folder + "/";
  if (!path.starts_with(prefix)) return std::nullopt;
  const size_t begin = path.find_first_not_of('/', prefix.size());
  return begin == std::string::npos ? std::string(".") : path.substr(begin);
}

/// Returns whether a relative path leads above its folder, without regard to links.
bool climbs_out(const std::string& relative) {
  int depth = 0;
  for (const std::filesystem::path& part : std::filesystem::path(relative)) {
    if (part == "..")
      --depth;
    else if (!part.empty() && part != ".")
      ++depth;
    if (depth < 0) return true;
  }
  return false;
}

int refuse() {
  errno = EXDEV;
  return -1;
}

}  // namespace

Confinement::Confinement(const std::string& folder, bool kernel_resolves)
    : folder_(folder), kernel_resolves_(kernel_resolves) {
  const std::string name = folder.empty() ? "." : folder;
  descriptor_ = ::open(name.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0) throw InputError({name}, std::string("the folder cannot be opened: ") + std::strerror(errno));
  std::error_code error;
  real_folder_ = std::filesystem::canonical(name, error).string();
}

Confinement::~Confinement() { ::close(descriptor_); }

int Confinement::open(const std::string& path, int flags) const {
  std::optional<std::string> relative = below(folder_, path);
  if (!relative && !real_folder_.empty()) {
    std::error_code error;
    const std::filesystem::path absolute = std::filesystem::absolute(path, error);
    if (!error) relative = below(real_folder_, absolute.lexically_normal().string());
  }
  if (!relative) return refuse();
  if (kernel_resolves_) {
    open_how how{};
    how.flags = static_cast<uint64_t>(flags);
    how.resolve = RESOLVE_BENEATH | RESOLVE_NO_MAGICLINKS;
    // EAGAIN: something on the path was renamed meanwhile, and the kernel cannot tell whether it led outside.
    for (int tries = 0; tries < 100; ++tries) {
      const long descriptor = ::syscall(SYS_openat2, descriptor_, relative->c_str(), &how, sizeof how);
      if (descriptor >= 0) return static_cast<int>(descriptor);
      if (errno != EAGAIN) break;
    }
    if (errno != ENOSYS && errno != EPERM) return -1;
  }
  return open_found(*relative, flags);
}

/// Finds the file without opening it for reading and checks where it is; the file opened then is the same one.
int Confinement::open_found(const std::string& relative, int flags) const {
  // Nothing above the folder is looked up at all.
  if (climbs_out(relative)) return refuse();
  const int found = ::openat(descriptor_, relative.c_str(), O_PATH | O_CLOEXEC);
  if (found < 0) return -1;
  const std::string folder = path_of(descriptor_), file = path_of(found);
  int result = -1;
  if (folder.empty() || file.empty() || !below(folder, file))
    refuse();
  else
    result = ::open(("/proc/self/fd/" + std::to_string(found)).c_str(), flags);
  const int problem = errno;
  ::close(found);
  errno = problem;
  return result;
}

}  // namespace alhazen::impl

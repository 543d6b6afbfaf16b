#include "files/file_identity.h"

#include <sys/stat.h>

#include <cerrno>
#include <filesystem>
#include <optional>

#include "util/diagnostics.h"

namespace alhazen::impl {

namespace {

namespace fs = std::filesystem;

/// Maximum number of consecutive links, as in Linux.
constexpr int max_links = 40;

/// Identified by device and inode if the file exists, else by those of its folder and its name.
struct FileIdentity {
  dev_t device = 0;
  ino_t inode = 0;
  std::string name;
  bool operator==(const FileIdentity&) const = default;
};

std::optional<FileIdentity> identity_of(const std::string& path) {
  int error = 0;
  const std::string target = follow_links(path, error);
  struct stat file = {};
  if (error != 0) return std::nullopt;
  if (::stat(target.c_str(), &file) == 0) {
    if (S_ISCHR(file.st_mode)) return std::nullopt;
    return FileIdentity{file.st_dev, file.st_ino, {}};
  }
  if (::stat(folder_of_path(target).c_str(), &file) != 0) return std::nullopt;
  return FileIdentity{file.st_dev, file.st_ino, fs::path(target).filename().string()};
}

}  // namespace

std::string folder_of_path(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  return folder.empty() ? "." : folder.string();
}

std::string follow_links(const std::string& path, int& error) {
  error = 0;
  struct stat file = {};
  // Links in /proc to pipes and devices, such as /dev/stdout, have no target with a name.
  if (::stat(path.c_str(), &file) == 0 && !S_ISREG(file.st_mode) && !S_ISDIR(file.st_mode)) return path;
  fs::path at = path;
  for (int links = 0; links <= max_links; ++links) {
    if (::lstat(at.c_str(), &file) != 0) {
      if (errno != ENOENT) error = errno;
      return at.string();
    }
    if (!S_ISLNK(file.st_mode)) return at.string();
    std::error_code failure;
    const fs::path target = fs::read_symlink(at, failure);
    if (failure) {
      error = failure.value();
      return at.string();
    }
    at = target.is_absolute() ? target : at.parent_path() / target;
  }
  error = ELOOP;
  return path;
}

bool is_same_file(const std::string& a, const std::string& b) {
  const std::optional<FileIdentity> one = identity_of(a), other = identity_of(b);
  return one && other && *one == *other;
}

void refuse_same_file(const NamedFile& written, const std::vector<NamedFile>& others) {
  for (const NamedFile& other : others)
    if (!written.path.empty() && !other.path.empty() && is_same_file(written.path, other.path))
      throw InputError({written.path}, written.role + " is the same file as " + other.role +
                                           (other.path == written.path ? "" : " " + other.path) +
                                           ": give it another name");
}

}  // namespace alhazen::impl

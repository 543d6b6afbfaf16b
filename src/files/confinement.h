#pragma once

// The folder that the files of a scene must not be outside of (`--confine`).

#include <string>

namespace alhazen::impl {

/// Opens files below one folder only: neither an absolute path, nor `..`, nor a symbolic link anywhere in the path
/// leads outside. The folder is held open, so renaming it changes nothing. Linux itself resolves the path within the
/// folder (openat2 with RESOLVE_BENEATH, Linux 5.6), so there is no moment between check and opening. If the kernel or
/// a sandbox lacks that call, the location of the file is checked after it is found and before it is read. Files that
/// are hard links or mounts in the folder count as inside: they cannot be distinguished.
class Confinement {
 public:
  /// Throws InputError if `folder` (empty: the current one) cannot be opened. `kernel_resolves`: whether openat2 may be
  /// used.
  explicit Confinement(const std::string& folder, bool kernel_resolves = true);
  ~Confinement();
  Confinement(const Confinement&) = delete;
  Confinement& operator=(const Confinement&) = delete;

  /// Returns a descriptor as open(2) does, or -1 with errno; EXDEV if `path` leads out of the folder. `path` is as the
  /// scene's reader made it: the folder's name and a path below it; other paths are relative to the current folder.
  int open(const std::string& path, int flags) const;

 private:
  int open_found(const std::string& relative, int flags) const;

  std::string folder_;       ///< as given
  std::string real_folder_;  ///< absolute, without symbolic links
  int descriptor_ = -1;
  bool kernel_resolves_;
};

}  // namespace alhazen::impl

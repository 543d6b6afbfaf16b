#pragma once

// The folder that the files of a scene must not leave (`--confine`).

#include <string>

namespace alhazen {

/// Opens files below one folder and none outside of it: not by an absolute path, by `..`, nor by a symbolic link
/// anywhere in the path. The folder is held open, so that renaming it changes nothing. Linux itself resolves the path
/// within the folder (openat2 with RESOLVE_BENEATH, Linux 5.6), so there is no moment between a check and the opening;
/// where a kernel or a sandbox has no such call, the file that was found is asked where it lies before it is read.
/// What lies in the folder by a hard link or a mount is in the folder: nothing can tell.
class Confinement {
 public:
  /// Throws InputError where `folder` (empty: the current one) cannot be opened. `kernel_resolves`: whether openat2 may
  /// be used.
  explicit Confinement(const std::string& folder, bool kernel_resolves = true);
  ~Confinement();
  Confinement(const Confinement&) = delete;
  Confinement& operator=(const Confinement&) = delete;

  /// A descriptor as of open(2), or -1 with errno; EXDEV where `path` leads out of the folder. `path` is as the scene's
  /// reader made it: the folder's name and what comes below it; other paths count from the current folder.
  int open(const std::string& path, int flags) const;

 private:
  int open_found(const std::string& relative, int flags) const;

  std::string folder_;       ///< as it was given
  std::string real_folder_;  ///< absolute, without symbolic links
  int descriptor_ = -1;
  bool kernel_resolves_;
};

}  // namespace alhazen

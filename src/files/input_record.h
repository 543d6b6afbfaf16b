#pragma once

// Records which files were read for a scene, so that none of them is overwritten.

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>

namespace alhazen::impl {

/// Identifies a file, whatever its name: device and inode.
using FileNumber = std::pair<uint64_t, uint64_t>;

/// The files that were opened, each with the name by which it was first opened. It is thread-safe.
class InputRecord {
 public:
  void add(const FileNumber& file, const std::string& name);

  /// Throws InputError if `path`, which messages call `role` ("the output"), is one of the files, by any name. An empty
  /// path is ignored.
  void refuse(const std::string& path, const std::string& role) const;

 private:
  mutable std::mutex mutex_;
  std::map<FileNumber, std::string> names_;
};

}  // namespace alhazen::impl

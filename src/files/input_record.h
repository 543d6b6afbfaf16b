#pragma once

// Which files were read for a scene, so that none of them is written over.

#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>

namespace alhazen {

/// What tells a file from every other one, whatever it is called: its device and its number there.
using FileNumber = std::pair<uint64_t, uint64_t>;

/// The files that were opened, each by the name it was first opened by. May be used by several threads at once.
class InputRecord {
 public:
  void add(const FileNumber& file, const std::string& name);

  /// Throws InputError where `path`, which the user knows as `role` ("the output"), is one of the files, by whatever
  /// name. An empty path is none.
  void refuse(const std::string& path, const std::string& role) const;

 private:
  mutable std::mutex mutex_;
  std::map<FileNumber, std::string> names_;
};

}  // namespace alhazen

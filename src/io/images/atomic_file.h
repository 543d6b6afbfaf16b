#pragma once

// A file that appears whole or not at all.

#include <cstddef>
#include <cstdint>
#include <string>

namespace alhazen {

/// Writes go to a temporary file in the folder of the target; `commit` renames it onto the target. Without a commit
/// the temporary is removed and the target stays as it was. A target that is a device or a pipe is written directly.
/// Every failure is a RenderError with the path, the cause and what to do. The first failure is remembered and told
/// again by `commit`, so that a library that swallows an exception of `write` cannot turn it into a success.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(const void* data, size_t size);
  void seek(uint64_t position);
  uint64_t position() const { return position_; }
  bool failed() const { return !failure_.empty(); }
  void commit();

 private:
  void create_temporary();
  [[noreturn]] void fail(int error);

  std::string path_;       ///< as the caller gave it, for messages
  std::string target_;     ///< what is replaced: `path_` with symbolic links followed
  std::string temporary_;  ///< empty where the target is written directly
  int descriptor_ = -1;
  uint64_t position_ = 0;
  std::string failure_;
};

}  // namespace alhazen

#pragma once

// A file that appears whole or not at all.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "util/diagnostics.h"

struct stat;

namespace alhazen {

/// `cannot write PATH: ` the cause and what to do.
class WriteError : public RenderError {
 public:
  WriteError(const std::string& path, int error);
  int error() const { return error_; }  ///< as errno has it
  /// The cause and what to do, without the path.
  static std::string reason(int error);

 private:
  int error_;
};

/// Writes go to a file without a name in the folder of the target (O_TMPFILE), which a process that is killed leaves
/// nothing of; `commit` gives it a name and renames it onto the target. Where the filesystem has no files without
/// names, a temporary file takes its place, and those that killed processes left are removed. Without a commit the
/// target stays as it was. Symbolic links are followed. A device is written directly; what is for a pipe is kept in
/// memory until `commit`, since formats seek.
/// Every failure is a WriteError. The first is remembered and told again by `commit`, so that a library that swallows
/// an exception of `write` cannot turn it into a success.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(const void* data, size_t size);
  void seek(uint64_t position);
  uint64_t position() const { return position_; }
  bool failed() const { return failure_ != 0; }
  void commit();

 private:
  void keep_owner_and_permissions(const struct stat& existing);
  void create_temporary();
  void create_named_temporary();
  void give_name();
  void write_pipe();
  void close_or_fail();
  [[noreturn]] void fail(int error);

  std::string path_;       ///< as the caller gave it, for messages
  std::string target_;     ///< what is replaced: `path_` with symbolic links followed
  std::string temporary_;  ///< empty where there is no file of that name
  bool replaces_ = false;  ///< whether `commit` renames: neither a device nor a pipe
  bool is_pipe_ = false;
  std::vector<char> for_pipe_;
  int descriptor_ = -1;
  uint64_t position_ = 0;
  int failure_ = 0;  ///< errno of the first
};

/// Throws InputError where `path` cannot be written now; leaves everything as it is. A full disk is no reason, since
/// space may be freed while the machine renders.
void check_target(const std::string& path);

/// A pipe may have no reader, or one that reads nothing. `is_over` is asked several times a second while that lasts;
/// once it returns true, the write fails after one second in which nothing moved. By default it lasts for ever.
void set_pipe_wait_is_over(bool (*is_over)());

}  // namespace alhazen

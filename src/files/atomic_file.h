#pragma once

// Writes a file completely or not at all.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "util/diagnostics.h"

struct stat;

namespace alhazen::impl {

/// The message is `cannot write PATH: `, the cause and what to do.
class WriteError : public RenderError {
 public:
  WriteError(const std::string& path, int error);
  int error() const { return error_; }  ///< an errno value
  /// The cause and what to do, without the path.
  static std::string reason(int error);

 private:
  int error_;
};

/// Writes go to a nameless file in the folder of the target (O_TMPFILE), of which nothing remains if the process is
/// killed; `commit` gives it a name and renames it to the target. If the filesystem does not support nameless files, a
/// temporary file is used instead, and temporaries of killed processes are removed. Without a commit the target remains
/// unchanged. Symbolic links are followed. Devices are written directly; data for a pipe are kept in memory until
/// `commit`, since image formats seek, and so are those for the path "-", which is standard output.
/// Every failure is a WriteError. The first is remembered and thrown again by `commit`, so that a library that swallows
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
  std::string target_;     ///< the file to replace: `path_` with symbolic links followed
  std::string temporary_;  ///< empty if there is no temporary file with a name
  bool replaces_ = false;  ///< whether `commit` renames; false for devices and pipes
  bool is_pipe_ = false;
  std::vector<char> for_pipe_;
  int descriptor_ = -1;
  uint64_t position_ = 0;
  int failure_ = 0;  ///< errno of the first failure
};

/// Throws InputError if `path` cannot be written now; changes nothing. A full disk is not an error here, since space
/// may be freed while the program renders.
void check_target(const std::string& path);

/// A pipe may have no reader, or one that reads nothing. While a write waits, `is_over` is called several times a
/// second; once it returns true, the write fails after one second without progress. By default it waits for ever.
void set_pipe_wait_is_over(bool (*is_over)());

}  // namespace alhazen::impl

#pragma once

// The one module that opens input: scenes, meshes, images, spectra, lenses, buffers, studies.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "files/confinement.h"
#include "files/input_record.h"

namespace alhazen::impl {

/// Restrictions and records common to all the files that one scene names.
struct InputScope {
  std::shared_ptr<const Confinement> confinement;  ///< the folder outside which no file is read; null: any
  std::shared_ptr<InputRecord> record;             ///< records the files that are opened; null: none
};

/// The path of a file to be read, and its scope. A plain string has no restrictions. Converting back to a string is
/// possible only by `name`, so that no reader drops the scope by accident.
struct InputPath {
  InputPath(std::string name_) : name(std::move(name_)) {}  // NOLINT(google-explicit-constructor)
  InputPath(const char* name_) : name(name_) {}             // NOLINT(google-explicit-constructor)
  InputPath(std::string name_, InputScope scope_) : name(std::move(name_)), scope(std::move(scope_)) {}

  std::string name;  ///< also used in messages
  InputScope scope;
};

/// An open regular file. Folders, devices, pipes and sockets are refused before they are opened, so that reading cannot
/// block, run without end or change the state of a device.
class InputFile {
 public:
  /// Throws InputError with the name of the file.
  explicit InputFile(const InputPath& path);
  ~InputFile();
  InputFile(InputFile&& other) noexcept;
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  InputFile& operator=(InputFile&&) = delete;

  const std::string& name() const { return name_; }
  uint64_t size() const { return size_; }
  int descriptor() const { return descriptor_; }
  /// Identifies the file: its device and inode.
  FileNumber identity() const { return identity_; }

  /// Reads up to `capacity` bytes from the current position; returns 0 at the end. Throws InputError.
  size_t read(void* into, size_t capacity);
  /// Reads the rest of the file. Throws InputError, also if memory does not suffice.
  std::vector<uint8_t> read_all();

 private:
  std::string name_;
  int descriptor_ = -1;
  uint64_t size_ = 0;
  FileNumber identity_;
};

/// Reads a file of a few numbers, such as a spectrum or a lens. Throws InputError, also if it has over 1 MiB.
std::vector<uint8_t> read_short_text(const InputPath& path);

/// Why a file cannot be opened, in the words of InputFile; the message is empty if it can.
struct InputProblem {
  std::string message;
  bool is_missing = false;  ///< no file has that name
};
InputProblem input_problem(const InputPath& path);

}  // namespace alhazen::impl

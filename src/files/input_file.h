#pragma once

// The one place where input is opened: scenes, meshes, pictures, spectra, lenses, buffers, studies.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "files/confinement.h"
#include "files/input_record.h"

namespace alhazen {

/// What holds for all the files that one scene names.
struct InputScope {
  std::shared_ptr<const Confinement> confinement;  ///< the folder that they must not lie outside of; null: any
  std::shared_ptr<InputRecord> record;             ///< where those that were opened are noted; null: nowhere
};

/// The path of a file to be read, and what holds for it. A plain string is bound by nothing. There is no way back to a
/// string but by `name`, so that no reader drops the bound without being seen to.
struct InputPath {
  InputPath(std::string name_) : name(std::move(name_)) {}  // NOLINT(google-explicit-constructor)
  InputPath(const char* name_) : name(name_) {}             // NOLINT(google-explicit-constructor)
  InputPath(std::string name_, InputScope scope_) : name(std::move(name_)), scope(std::move(scope_)) {}

  std::string name;  ///< also as messages have it
  InputScope scope;
};

/// An open regular file. Folders, devices, pipes and sockets are refused before they are opened, so that nothing waits
/// for a writer, reads without end or changes the state of a device.
class InputFile {
 public:
  /// Throws InputError that names the file.
  explicit InputFile(const InputPath& path);
  ~InputFile();
  InputFile(InputFile&& other) noexcept;
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  InputFile& operator=(InputFile&&) = delete;

  const std::string& name() const { return name_; }
  uint64_t size() const { return size_; }
  int descriptor() const { return descriptor_; }
  /// What tells it from every other file: its device and its number there.
  FileNumber identity() const { return identity_; }

  /// Up to `capacity` bytes from where the last reading ended; 0 at the end. Throws InputError.
  size_t read(void* into, size_t capacity);
  /// All of it, from where the last reading ended. Throws InputError, also where memory does not hold it.
  std::vector<uint8_t> read_all();

 private:
  std::string name_;
  int descriptor_ = -1;
  uint64_t size_ = 0;
  FileNumber identity_;
};

/// The bytes of a file of a few numbers, a spectrum or a lens; over 1 MiB it is none. Throws InputError.
std::vector<uint8_t> read_short_text(const InputPath& path);

/// Why a file cannot be opened, as InputFile would say it; without a message where it can.
struct InputProblem {
  std::string message;
  bool is_missing = false;  ///< there is nothing of that name
};
InputProblem input_problem(const InputPath& path);

}  // namespace alhazen

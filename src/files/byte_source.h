#pragma once

// Where the bytes of a text scene or a PLY mesh come from: a file, compressed by gzip or not, or memory.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "files/input_file.h"

namespace alhazen {

class ByteSource {
 public:
  virtual ~ByteSource() = default;

  /// Fills `into` with up to `capacity` bytes and returns how many; 0 at the end. Throws InputError.
  virtual size_t read(char* into, size_t capacity) = 0;

  /// How many bytes one may reckon with: memory is reserved for no more than these could describe, whatever a header
  /// promises. Exact for a file that is not compressed.
  virtual uint64_t plausible_size() const = 0;
};

class MemorySource final : public ByteSource {
 public:
  explicit MemorySource(std::string_view bytes) : left_(bytes), size_(bytes.size()) {}
  size_t read(char* into, size_t capacity) override;
  uint64_t plausible_size() const override { return size_; }

 private:
  std::string_view left_;
  uint64_t size_;
};

/// A file, through zlib, which hands on what is not compressed.
class FileSource final : public ByteSource {
 public:
  explicit FileSource(const InputPath& path) : FileSource(InputFile(path)) {}
  explicit FileSource(const InputFile& file);
  ~FileSource() override;
  FileSource(const FileSource&) = delete;
  FileSource& operator=(const FileSource&) = delete;
  size_t read(char* into, size_t capacity) override;
  uint64_t plausible_size() const override;

 private:
  struct Handle;
  std::string path_;
  uint64_t size_;
  std::unique_ptr<Handle> handle_;
};

}  // namespace alhazen

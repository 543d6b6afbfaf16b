#pragma once

// Sources of the bytes of a text scene or a PLY mesh: a file, optionally compressed by gzip, or memory.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "files/input_file.h"

namespace alhazen::impl {

class ByteSource {
 public:
  virtual ~ByteSource() = default;

  /// Reads up to `capacity` bytes into `into` and returns the number read; 0 at the end. Throws InputError.
  virtual size_t read(char* into, size_t capacity) = 0;

  /// An estimate of the number of bytes: no more memory is reserved than these could describe, whatever a header
  /// claims. It is exact for uncompressed files.
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

/// A file read by zlib, which passes on uncompressed data unchanged.
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

}  // namespace alhazen::impl

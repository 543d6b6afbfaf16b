#pragma once

// A window over a stream of bytes that keeps the data to be decoded contiguous.

#include <cstring>
#include <memory>

#include "files/byte_source.h"

namespace alhazen::impl {

class InputBuffer {
 public:
  static constexpr size_t capacity = 1u << 18;

  explicit InputBuffer(ByteSource& source) : source_(source), bytes_(new char[capacity]) {}

  /// True if `wanted` bytes, at most `capacity`, are in memory; false if the stream ends before.
  bool require(size_t wanted) { return available() >= wanted || refill(wanted); }

  const char* data() const { return bytes_.get() + begin_; }
  size_t available() const { return end_ - begin_; }
  void skip(size_t count) { begin_ += count; }

  /// The offset of data() in the stream.
  uint64_t offset() const { return offset_of_buffer_ + begin_; }

 private:
  bool refill(size_t wanted) {
    std::memmove(bytes_.get(), data(), available());
    offset_of_buffer_ += begin_;
    end_ -= begin_;
    begin_ = 0;
    while (end_ < wanted && !at_end_) {
      const size_t count = source_.read(bytes_.get() + end_, capacity - end_);
      end_ += count;
      at_end_ = count == 0;
    }
    return end_ >= wanted;
  }

  ByteSource& source_;
  std::unique_ptr<char[]> bytes_;
  size_t begin_ = 0, end_ = 0;
  uint64_t offset_of_buffer_ = 0;
  bool at_end_ = false;
};

}  // namespace alhazen::impl

#pragma once

// A cursor over the bytes of a file that cannot run past their end.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "images/codecs/image_bytes.h"

namespace alhazen::impl {

/// Multi-byte numbers are little-endian. Every read past the end throws InputError.
class ByteReader {
 public:
  ByteReader(const std::string& path, std::span<const uint8_t> bytes) : path_(path), bytes_(bytes) {}

  size_t position() const { return position_; }
  size_t remaining() const { return bytes_.size() - position_; }

  std::span<const uint8_t> take(size_t count) {
    if (count > remaining()) throw_malformed(path_, "the image ends too early; it is truncated or damaged");
    position_ += count;
    return bytes_.subspan(position_ - count, count);
  }
  void skip(size_t count) { take(count); }
  void seek(size_t position) {
    position_ = 0;
    take(position);
  }

  uint8_t u8() { return take(1)[0]; }
  uint16_t u16() {
    const auto b = take(2);
    return static_cast<uint16_t>(b[0] | b[1] << 8);
  }
  uint32_t u32() {
    const uint32_t low = u16();
    return low | static_cast<uint32_t>(u16()) << 16;
  }
  int32_t i32() { return static_cast<int32_t>(u32()); }

  /// The text up to the next line feed, which is consumed but not returned.
  std::string_view line() {
    const size_t start = position_;
    while (u8() != '\n') {
    }
    return {reinterpret_cast<const char*>(bytes_.data()) + start, position_ - start - 1};
  }

  [[noreturn]] void fail(const std::string& message) const { throw_malformed(path_, message); }

 private:
  const std::string& path_;
  std::span<const uint8_t> bytes_;
  size_t position_ = 0;
};

}  // namespace alhazen::impl

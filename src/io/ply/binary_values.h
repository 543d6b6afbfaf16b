#pragma once

// The values of binary PLY data, in either byte order.

#include <algorithm>
#include <bit>
#include <cstring>
#include <string>

#include "io/ply/input_buffer.h"
#include "io/ply/ply_header.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

/// Has the same members as AsciiValues; the row readers are templates over either.
template <std::endian order>
class BinaryValues {
 public:
  BinaryValues(InputBuffer& input, const std::string& name) : input_(input), name_(name) {}

  void begin_row(const PlyElement& element, uint64_t index) {
    element_ = &element;
    index_ = index;
  }
  void end_row() {}

  double real(const PlyProperty& property) {
    if (property.type == PlyType::float32) return static_cast<double>(std::bit_cast<float>(next<uint32_t>()));
    if (property.type == PlyType::float64) return std::bit_cast<double>(next<uint64_t>());
    return static_cast<double>(integer(property.type));
  }

  int64_t integer(const PlyProperty& property) { return integer(property.type); }

  uint64_t list_length(const PlyProperty& property) {
    const int64_t length = integer(property.length_type);
    if (length < 0) fail("a list of " + std::to_string(length) + " values");
    return static_cast<uint64_t>(length);
  }

  void skip(const PlyProperty& property, uint64_t count) {
    // At most 2^32 values of 8 bytes, so this cannot overflow.
    uint64_t left = count * size_of(property.type);
    while (left > 0) {
      if (!input_.require(1)) fail_at_end();
      const size_t step = static_cast<size_t>(std::min<uint64_t>(left, input_.available()));
      input_.skip(step);
      left -= step;
    }
  }

  /// Throws an error in the current row. Binary data have no lines, so the element and its number, from 0, locate it.
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError({name_}, element_->name + " " + std::to_string(index_) + ": " + message);
  }

  /// Warns if data follow.
  void expect_end(Diagnostics& diagnostics) {
    if (input_.require(1)) diagnostics.warn({name_}, "data after the last element are ignored");
  }

 private:
  [[noreturn]] void fail_at_end() const {
    fail("the file ends here; the header promises " + std::to_string(element_->count) + " of element '" +
         element_->name + "'");
  }

  template <class Unsigned>
  Unsigned next() {
    if (!input_.require(sizeof(Unsigned))) fail_at_end();
    Unsigned bits;
    std::memcpy(&bits, input_.data(), sizeof bits);
    input_.skip(sizeof bits);
    if constexpr (order != std::endian::native) bits = swapped(bits);
    return bits;
  }

  static uint8_t swapped(uint8_t bits) { return bits; }
  static uint16_t swapped(uint16_t bits) { return __builtin_bswap16(bits); }
  static uint32_t swapped(uint32_t bits) { return __builtin_bswap32(bits); }
  static uint64_t swapped(uint64_t bits) { return __builtin_bswap64(bits); }

  int64_t integer(PlyType type) {
    switch (type) {
      case PlyType::int8:
        return static_cast<int8_t>(next<uint8_t>());
      case PlyType::uint8:
        return next<uint8_t>();
      case PlyType::int16:
        return static_cast<int16_t>(next<uint16_t>());
      case PlyType::uint16:
        return next<uint16_t>();
      case PlyType::int32:
        return static_cast<int32_t>(next<uint32_t>());
      case PlyType::uint32:
        return next<uint32_t>();
      case PlyType::float32:
      case PlyType::float64:
        break;
    }
    // The row readers read integers only if the header declares them.
    fail("an integer is expected");
  }

  InputBuffer& input_;
  const std::string& name_;
  const PlyElement* element_ = nullptr;
  uint64_t index_ = 0;
};

}  // namespace alhazen::impl

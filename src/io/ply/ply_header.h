#pragma once

// The header of a PLY file: its elements and their layout.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/ply/input_buffer.h"

namespace alhazen::impl {

enum class PlyFormat { ascii, binary_little_endian, binary_big_endian };

enum class PlyType : uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

/// Bytes of a value in binary data.
size_t size_of(PlyType type);
bool is_integer(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  bool is_list = false;
  PlyType length_type = PlyType::uint8;  ///< of a list: type of the number of values, which precedes them
};

struct PlyElement {
  std::string name;
  uint64_t count = 0;
  std::vector<PlyProperty> properties;
  int line = 0;  ///< in the header

  /// The property of this name, or -1.
  int find(std::string_view property) const;
  /// The minimum number of bytes of a row.
  size_t smallest_row(PlyFormat format) const;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  int lines = 0;  ///< of the whole header; the data begin on the next one

  const PlyElement* find(std::string_view element) const;
};

/// Reads up to and including the line `end_header`. `name` is the file, for messages. Throws InputError.
PlyHeader read_ply_header(InputBuffer& input, const std::string& name);

}  // namespace alhazen::impl

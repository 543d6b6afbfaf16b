#pragma once

// The values of ascii PLY data, in which each row of an element is one line.

#include <string>
#include <string_view>

#include "io/ply/input_buffer.h"
#include "io/ply/ply_header.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

/// Has the same members as BinaryValues; the row readers are templates over either.
class AsciiValues {
 public:
  AsciiValues(InputBuffer& input, const std::string& name, const PlyHeader& header);

  void begin_row(const PlyElement& element, uint64_t index);
  void end_row();

  double real(const PlyProperty& property);
  int64_t integer(const PlyProperty& property);
  uint64_t list_length(const PlyProperty& property);
  void skip(const PlyProperty& property, uint64_t count);

  /// Throws an error at the value that was read last.
  [[noreturn]] void fail(const std::string& message) const;
  /// Warns if something other than blanks follows.
  void expect_end(Diagnostics& diagnostics);

 private:
  std::string_view next_word(const PlyProperty& property);
  void skip_blanks();
  bool skip_blank_lines();
  SourceLocation place(uint64_t offset) const;

  InputBuffer& input_;
  const std::string& name_;
  const PlyElement* element_ = nullptr;
  uint64_t index_ = 0;
  int line_;
  uint64_t line_offset_;      ///< of the first byte of the line in the stream
  uint64_t word_offset_ = 0;  ///< of the word that was read last
};

}  // namespace alhazen::impl

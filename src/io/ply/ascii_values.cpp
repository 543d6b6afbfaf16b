#include "io/ply/ascii_values.h"

#include <algorithm>
#include <limits>

#include "util/numbers.h"
#include "util/quoted.h"

namespace alhazen::impl {

namespace {

/// Longer than any number; it bounds how far ahead the buffer must reach.
constexpr size_t max_word = 512;

bool is_blank(char c) { return c == ' ' || c == '\t'; }
/// A line ends with a line feed, a carriage return, or both.
bool is_line_end(char c) { return c == '\n' || c == '\r'; }

}  // namespace

AsciiValues::AsciiValues(InputBuffer& input, const std::string& name, const PlyHeader& header)
    : input_(input), name_(name), line_(header.lines + 1), line_offset_(input.offset()) {}

SourceLocation AsciiValues::place(uint64_t offset) const {
  const uint64_t column = offset - line_offset_ + 1;
  constexpr uint64_t largest = std::numeric_limits<int>::max();
  return {name_, line_, static_cast<int>(column < largest ? column : largest)};
}

void AsciiValues::fail(const std::string& message) const {
  throw InputError(place(word_offset_), element_->name + " " + std::to_string(index_) + ": " + message);
}

void AsciiValues::skip_blanks() {
  do {
    const char* const begin = input_.data();
    const char* const end = begin + input_.available();
    const char* c = begin;
    while (c < end && is_blank(*c)) ++c;
    input_.skip(static_cast<size_t>(c - begin));
    if (c < end) return;
  } while (input_.require(1));
}

/// Advances to the next line that is not blank; returns false if there is none.
bool AsciiValues::skip_blank_lines() {
  while (true) {
    skip_blanks();
    if (!input_.require(1)) return false;
    if (!is_line_end(*input_.data())) return true;
    const bool is_pair = *input_.data() == '\r' && input_.require(2) && input_.data()[1] == '\n';
    input_.skip(is_pair ? 2 : 1);
    if (line_ < std::numeric_limits<int>::max()) ++line_;
    line_offset_ = input_.offset();
  }
}

void AsciiValues::begin_row(const PlyElement& element, uint64_t index) {
  element_ = &element;
  index_ = index;
  const bool found = skip_blank_lines();
  word_offset_ = input_.offset();
  if (!found)
    fail("the file ends here; the header promises " + std::to_string(element.count) + " of element " +
         quoted(element.name));
}

void AsciiValues::end_row() {
  skip_blanks();
  if (!input_.require(1) || is_line_end(*input_.data())) return;
  word_offset_ = input_.offset();
  fail("there is one value too many; the header gives " + std::to_string(element_->properties.size()) +
       " properties, and each row must be on its own line");
}

std::string_view AsciiValues::next_word(const PlyProperty& property) {
  skip_blanks();
  input_.require(max_word);
  word_offset_ = input_.offset();
  const char* const begin = input_.data();
  const char* const end = begin + std::min(input_.available(), max_word);
  const char* c = begin;
  while (c < end && !is_blank(*c) && !is_line_end(*c)) ++c;
  const std::string_view word(begin, static_cast<size_t>(c - begin));
  if (word.empty()) fail("the line ends where a value of " + quoted(property.name) + " is expected");
  if (word.size() == max_word) fail(quoted(word) + " is too long for a number");
  input_.skip(word.size());
  return word;
}

double AsciiValues::real(const PlyProperty& property) {
  const std::string_view word = next_word(property);
  const std::optional<double> value = parse_real(word);
  if (!value) fail(quoted(word) + " is not a number; expected a value of " + quoted(property.name));
  return *value;
}

int64_t AsciiValues::integer(const PlyProperty& property) {
  const std::string_view word = next_word(property);
  const std::optional<int64_t> value = parse_integer(word);
  if (!value) fail(quoted(word) + " is not an integer; expected a value of " + quoted(property.name));
  return *value;
}

uint64_t AsciiValues::list_length(const PlyProperty& property) {
  const int64_t length = integer(property);
  if (length < 0) fail("a list of " + std::to_string(length) + " values");
  return static_cast<uint64_t>(length);
}

void AsciiValues::skip(const PlyProperty& property, uint64_t count) {
  for (uint64_t i = 0; i < count; ++i) next_word(property);
}

void AsciiValues::expect_end(Diagnostics& diagnostics) {
  // The rest of the last row was checked by end_row.
  if (skip_blank_lines()) diagnostics.warn(place(input_.offset()), "data after the last element are ignored");
}

}  // namespace alhazen::impl

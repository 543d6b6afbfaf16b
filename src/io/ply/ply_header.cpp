#include "io/ply/ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <set>

#include "util/diagnostics.h"
#include "util/quoted.h"

namespace alhazen::impl {

namespace {

/// In the order of PlyType: the name in the format of 1994, the name that later writers use, and the size in bytes.
struct TypeInfo {
  std::string_view name, later_name;
  size_t size;
};

constexpr std::array<TypeInfo, 8> types{{
    {"char", "int8", 1},
    {"uchar", "uint8", 1},
    {"short", "int16", 2},
    {"ushort", "uint16", 2},
    {"int", "int32", 4},
    {"uint", "uint32", 4},
    {"float", "float32", 4},
    {"double", "float64", 8},
}};

/// Limit on the header: a longer one means that some other file begins with "ply".
constexpr uint64_t max_header = 1u << 20;

struct Word {
  std::string_view text;
  int column = 0;
};

class HeaderReader {
 public:
  HeaderReader(InputBuffer& input, const std::string& name) : input_(input), name_(name) {}

  PlyHeader read();

 private:
  void read_magic();
  void read_line();
  void read_format();
  void read_element();
  void read_property();
  PlyType read_type(const Word& word) const;
  void expect_words(size_t count, const char* usage) const;
  [[noreturn]] void fail(int column, const std::string& message) const;

  InputBuffer& input_;
  const std::string& name_;
  std::string line_;
  std::vector<Word> words_;
  bool format_known_ = false;
  bool ends_with_return_ = false;  ///< lines end with a carriage return, not with a line feed
  std::set<std::string, std::less<>> element_names_, property_names_;
  PlyHeader header_;
};

void HeaderReader::fail(int column, const std::string& message) const {
  std::string excerpt;
  if (column > 0 && !line_.empty()) {
    const std::string text = quoted(line_);
    excerpt = "  " + text.substr(1, text.size() - 2);
  }
  throw InputError({name_, header_.lines, column}, message, excerpt);
}

void HeaderReader::read_magic() {
  header_.lines = 1;
  const bool begins = input_.require(4) && std::string_view(input_.data(), 3) == "ply";
  if (!begins || (input_.data()[3] != '\n' && input_.data()[3] != '\r'))
    fail(1, "not a PLY file: the first line must be 'ply'");
  // Old Macintosh programs end lines with a carriage return alone. The data begin right after the last one, so a line
  // feed there is the first byte of binary data.
  ends_with_return_ = input_.data()[3] == '\r' && !(input_.require(5) && input_.data()[4] == '\n');
  header_.lines = 0;
  read_line();
}

/// Reads the next line without its end, split into words.
void HeaderReader::read_line() {
  line_.clear();
  words_.clear();
  ++header_.lines;
  while (true) {
    if (!input_.require(1)) fail(static_cast<int>(line_.size()) + 1, "the file ends within the header");
    if (input_.offset() >= max_header) fail(1, "the header has no 'end_header' within its first MiB");
    const char c = *input_.data();
    input_.skip(1);
    if (c == (ends_with_return_ ? '\r' : '\n')) break;
    line_ += c;
  }
  if (!line_.empty() && line_.back() == '\r') line_.pop_back();

  constexpr const char* blanks = " \t";
  size_t begin = line_.find_first_not_of(blanks);
  while (begin != line_.npos) {
    const size_t end = std::min(line_.find_first_of(blanks, begin), line_.size());
    words_.push_back({std::string_view(line_).substr(begin, end - begin), static_cast<int>(begin) + 1});
    begin = line_.find_first_not_of(blanks, end);
  }
}

void HeaderReader::expect_words(size_t count, const char* usage) const {
  if (words_.size() < count)
    fail(static_cast<int>(line_.size()) + 1, std::string("the line ends too early; expected: ") + usage);
  if (words_.size() > count)
    fail(words_[count].column, "unexpected " + quoted(words_[count].text) + "; expected: " + usage);
}

void HeaderReader::read_format() {
  expect_words(3, "format (ascii | binary_little_endian | binary_big_endian) 1.0");
  if (format_known_) fail(words_[0].column, "a second 'format'");
  const std::string_view format = words_[1].text;
  if (format == "ascii")
    header_.format = PlyFormat::ascii;
  else if (format == "binary_little_endian")
    header_.format = PlyFormat::binary_little_endian;
  else if (format == "binary_big_endian")
    header_.format = PlyFormat::binary_big_endian;
  else
    fail(words_[1].column,
         "unknown format " + quoted(format) + "; known are ascii, binary_little_endian and binary_big_endian");
  if (words_[2].text != "1.0") fail(words_[2].column, "unknown version " + quoted(words_[2].text) + "; known is 1.0");
  format_known_ = true;
}

void HeaderReader::read_element() {
  expect_words(3, "element NAME COUNT");
  PlyElement element;
  element.name = words_[1].text;
  element.line = header_.lines;
  const std::string_view count = words_[2].text;
  const auto [stop, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
  if (error != std::errc() || stop != count.data() + count.size())
    fail(words_[2].column, quoted(count) + " is not a count of elements");
  if (!element_names_.insert(element.name).second) fail(words_[1].column, "a second element " + quoted(element.name));
  property_names_.clear();
  header_.elements.push_back(std::move(element));
}

PlyType HeaderReader::read_type(const Word& word) const {
  for (size_t i = 0; i < types.size(); ++i)
    if (word.text == types[i].name || word.text == types[i].later_name) return static_cast<PlyType>(i);
  fail(word.column,
       "unknown type " + quoted(word.text) + "; known are char, uchar, short, ushort, int, uint, float, double");
}

void HeaderReader::read_property() {
  if (header_.elements.empty()) fail(words_[0].column, "a property before the first element");
  PlyProperty property;
  property.is_list = words_.size() > 1 && words_[1].text == "list";
  if (property.is_list) {
    expect_words(5, "property list LENGTH_TYPE TYPE NAME");
    property.length_type = read_type(words_[2]);
    if (!is_integer(property.length_type)) fail(words_[2].column, "the length of a list must be of an integer type");
  } else {
    expect_words(3, "property TYPE NAME");
  }
  const size_t count = words_.size();
  property.type = read_type(words_[count - 2]);
  property.name = words_[count - 1].text;
  if (!property_names_.insert(property.name).second)
    fail(words_[count - 1].column,
         "a second property " + quoted(property.name) + " of element " + quoted(header_.elements.back().name));
  header_.elements.back().properties.push_back(std::move(property));
}

PlyHeader HeaderReader::read() {
  read_magic();
  while (true) {
    read_line();
    if (words_.empty()) continue;
    const std::string_view keyword = words_[0].text;
    if (keyword == "comment" || keyword == "obj_info") continue;
    if (keyword == "end_header") break;
    if (keyword == "format")
      read_format();
    else if (keyword == "element")
      read_element();
    else if (keyword == "property")
      read_property();
    else
      fail(words_[0].column, "unknown keyword " + quoted(keyword) + " in the header");
  }
  expect_words(1, "end_header");
  if (!format_known_) fail(1, "the header has no line 'format'");
  return std::move(header_);
}

}  // namespace

size_t size_of(PlyType type) { return types[static_cast<size_t>(type)].size; }

bool is_integer(PlyType type) { return type != PlyType::float32 && type != PlyType::float64; }

int PlyElement::find(std::string_view property) const {
  for (size_t i = 0; i < properties.size(); ++i)
    if (properties[i].name == property) return static_cast<int>(i);
  return -1;
}

size_t PlyElement::smallest_row(PlyFormat format) const {
  // In ascii a value takes at least one digit and a blank or line end.
  if (format == PlyFormat::ascii) return 2 * properties.size();
  size_t bytes = 0;
  for (const PlyProperty& property : properties)
    bytes += size_of(property.is_list ? property.length_type : property.type);
  return bytes;
}

const PlyElement* PlyHeader::find(std::string_view element) const {
  for (const PlyElement& candidate : elements)
    if (candidate.name == element) return &candidate;
  return nullptr;
}

PlyHeader read_ply_header(InputBuffer& input, const std::string& name) { return HeaderReader(input, name).read(); }

}  // namespace alhazen::impl

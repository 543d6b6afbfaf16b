#include "io/obj/lines.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include "util/parse_numbers.h"
#include "util/quoted.h"

namespace alhazen::impl::obj {

namespace {

constexpr size_t max_line_bytes = size_t{1} << 26;
constexpr size_t chunk_bytes = size_t{1} << 18;

/// Whether the arguments of a statement are names: of objects, materials or files.
bool takes_names(std::string_view statement) {
  std::string lower(statement);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  static const std::set<std::string_view> others{"o",      "g",    "usemtl", "mtllib", "usemap", "maplib",
                                                 "newmtl", "bump", "norm",   "disp",   "decal",  "refl"};
  return lower.starts_with("map_") || others.contains(lower);
}

}  // namespace

/// Appends one line of the file to `line_`, without its end. Lines end with a line feed, a carriage return, or both.
bool Lines::read_line() {
  bool any = false;
  while (true) {
    if (at_ == buffer_.size()) {
      buffer_.resize(chunk_bytes);
      buffer_.resize(source_.read(buffer_.data(), buffer_.size()));
      at_ = 0;
      if (buffer_.empty()) return any;
    }
    any = true;
    const size_t end = std::min(buffer_.find_first_of("\r\n", at_), buffer_.size());
    line_.append(buffer_, at_, end - at_);
    if (line_.size() > max_line_bytes)
      throw InputError({name_, lines_read_ + 1}, "a line has over 64 MiB; this is not such a file, or it is damaged");
    at_ = end;
    if (end == buffer_.size()) continue;
    const bool is_return = buffer_[at_++] == '\r';
    ++lines_read_;
    if (!is_return) return true;
    if (at_ == buffer_.size()) {
      buffer_.resize(chunk_bytes);
      buffer_.resize(source_.read(buffer_.data(), buffer_.size()));
      at_ = 0;
    }
    if (at_ < buffer_.size() && buffer_[at_] == '\n') ++at_;
    return true;
  }
}

bool Lines::next() {
  while (true) {
    line_.clear();
    number_ = lines_read_ + 1;
    if (!read_line()) return false;
    while (!line_.empty() && line_.back() == '\\') {
      line_.back() = ' ';
      if (!read_line()) break;
    }
    split_line();
    if (!words_.empty()) return true;
  }
}

/// Finds the words of `line_`, and cuts a comment off it.
void Lines::split_line() {
  constexpr std::string_view blanks = " \t\v\f";
  words_.clear();
  const std::string_view line = line_;
  for (size_t begin = line.find_first_not_of(blanks); begin != std::string_view::npos;) {
    if (line[begin] == '#' && (words_.empty() || !takes_names(words_[0].text))) {
      line_.resize(begin);  // shorter, so that the words remain valid
      return;
    }
    const size_t end = std::min(line.find_first_of(blanks, begin), line.size());
    words_.push_back({line.substr(begin, end - begin), static_cast<int>(begin) + 1});
    begin = line.find_first_not_of(blanks, end);
  }
}

std::string_view Lines::rest(size_t first) const {
  if (first >= words_.size()) return {};
  const size_t begin = static_cast<size_t>(words_[first].column - 1);
  const Word& last = words_.back();
  return std::string_view(line_).substr(begin, static_cast<size_t>(last.column - 1) + last.text.size() - begin);
}

SourceLocation Lines::place(size_t word) const {
  return {name_, number_, word < words_.size() ? words_[word].column : static_cast<int>(line_.size()) + 1};
}

void Lines::fail(size_t word, const std::string& message) const { throw InputError(place(word), message); }

double Lines::number(size_t word) const {
  double value = 0;
  if (word >= words_.size()) fail(word, "a number is missing after " + quoted(words_[0].text));
  if (!parse_number(words_[word].text, value) || !std::isfinite(value))
    fail(word, quoted(words_[word].text) + " is not a finite number");
  return value;
}

}  // namespace alhazen::impl::obj

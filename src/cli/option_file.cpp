#include "cli/option_file.h"

#include <algorithm>
#include <string_view>

#include "files/input_file.h"
#include "util/quoted.h"

namespace alhazen::impl {

namespace {

constexpr std::string_view blanks = " \t\r\v\f", byte_order_mark = "\xef\xbb\xbf";

std::string_view trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) + 1 - first);
}

class OptionFile {
 public:
  explicit OptionFile(const std::string& path) : path_(path) {
    const std::vector<uint8_t> bytes = read_short_text(path);
    text_.assign(bytes.begin(), bytes.end());
    rest_ = text_;
    if (rest_.starts_with(byte_order_mark)) rest_.remove_prefix(byte_order_mark.size());
  }

  std::vector<FileOption> read() {
    std::vector<FileOption> options;
    while (next_line()) {
      if (line_.empty() || line_[0] == '#' || line_[0] == ';') continue;
      if (line_[0] == '[')
        read_section();
      else
        options.push_back(read_option());
    }
    return options;
  }

 private:
  bool next_line() {
    if (rest_.empty()) return false;
    const size_t end = rest_.find('\n');
    line_ = trimmed(rest_.substr(0, end));
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++number_;
    return true;
  }

  [[noreturn]] void fail(int line, const std::string& message) const { throw InputError({path_, line}, message); }

  void read_section() {
    const size_t end = line_.find(']');
    if (end == std::string_view::npos || !is_comment(line_.substr(end + 1)))
      fail(number_, "a section is a name in brackets: [render]");
    const std::string name(trimmed(line_.substr(1, end - 1)));
    section_ = name == "render" || name == "default" ? "" : name + ".";
  }

  static bool is_comment(std::string_view text) {
    const std::string_view left = trimmed(text);
    return left.empty() || left[0] == '#';
  }

  FileOption read_option() {
    const int line = number_;
    const size_t equals = line_.find_first_of("=#");
    const bool has_value = equals != std::string_view::npos && line_[equals] == '=';
    std::string name(trimmed(line_.substr(0, equals)));
    if (name.size() > 1 && (name[0] == '"' || name[0] == '\'') && name.back() == name[0])
      name = name.substr(1, name.size() - 2);
    if (name.empty()) fail(line, "this is no option: write name = value");
    if (section_.empty() && name.starts_with("render.")) name.erase(0, 7);
    name = section_ + name;
    FileOption option{name, {"true"}, {path_, line}};
    if (!has_value) return option;
    line_ = trimmed(line_.substr(equals + 1));
    option.values = line_.starts_with('[') ? read_array(option) : read_value(option);
    bool is_missing = option.values.empty();
    for (const std::string& value : option.values) is_missing = is_missing || value.empty();
    if (is_missing) fail(line, quoted(name) + " has no value: give one, or leave the line out");
    return option;
  }

  /// Takes one value in quotes from the front of `line_`.
  std::string take_quoted(const FileOption& option) {
    const size_t end = line_.find(line_[0], 1);
    if (end == std::string_view::npos)
      fail(number_,
           "the value of " + quoted(option.name) + " has a quotation mark at its beginning, and none after it");
    const std::string value(line_.substr(1, end - 1));
    line_ = trimmed(line_.substr(end + 1));
    return value;
  }

  bool begins_quoted() const { return line_.starts_with('"') || line_.starts_with('\''); }

  std::vector<std::string> read_value(const FileOption& option) {
    if (begins_quoted()) {
      std::vector<std::string> values{take_quoted(option)};
      if (!is_comment(line_))
        fail(number_, "the value of " + quoted(option.name) + " goes on after its quotation mark");
      return values;
    }
    line_ = trimmed(line_.substr(0, line_.find('#')));
    std::vector<std::string> values;
    while (!line_.empty()) {
      const size_t end = std::min(line_.find_first_of(", \t"), line_.size());
      values.emplace_back(line_.substr(0, end));
      line_ = trimmed(line_.substr(end));
      if (line_.starts_with(',')) line_ = trimmed(line_.substr(1));
    }
    return values;
  }

  /// From [ to ], over several lines.
  std::vector<std::string> read_array(const FileOption& option) {
    std::vector<std::string> values;
    line_ = trimmed(line_.substr(1));
    while (true) {
      while (is_comment(line_))
        if (!next_line()) fail(option.where.line, "the array of " + quoted(option.name) + " has no ] at its end");
      if (line_[0] == ']') break;
      if (begins_quoted()) {
        values.push_back(take_quoted(option));
      } else {
        const size_t end = std::min(line_.find_first_of(",]#"), line_.size());
        values.emplace_back(trimmed(line_.substr(0, end)));
        line_ = trimmed(line_.substr(end));
      }
      if (line_.starts_with(','))
        line_ = trimmed(line_.substr(1));
      else if (!line_.starts_with(']') && !is_comment(line_))
        fail(number_, "the values of " + quoted(option.name) + " need a comma between them");
    }
    if (!is_comment(line_.substr(1))) fail(number_, "the array of " + quoted(option.name) + " goes on after its ]");
    return values;
  }

  std::string path_, text_;
  std::string_view rest_, line_;  ///< of `text_`: what is not read yet, and what is left of the line
  int number_ = 0;                ///< of the line
  std::string section_;           ///< with its dot
};

}  // namespace

std::vector<FileOption> read_option_file(const std::string& path) { return OptionFile(path).read(); }

}  // namespace alhazen::impl

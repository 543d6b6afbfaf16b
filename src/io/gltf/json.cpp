#include "io/gltf/json.h"

#include <cmath>
#include <utility>

#include "util/diagnostics.h"
#include "util/json_depth.h"
#include "util/numbers.h"
#include "util/quoted.h"

namespace alhazen::impl::gltf {

namespace {

/// Limits the linear search for names.
constexpr size_t max_names = 4096;

void append_utf8(std::string& text, uint32_t code) {
  const auto add = [&](uint32_t byte) { text += static_cast<char>(byte); };
  if (code < 0x80) {
    add(code);
  } else if (code < 0x800) {
    add(0xc0 | code >> 6);
    add(0x80 | (code & 0x3f));
  } else if (code < 0x10000) {
    add(0xe0 | code >> 12);
    add(0x80 | (code >> 6 & 0x3f));
    add(0x80 | (code & 0x3f));
  } else {
    add(0xf0 | code >> 18);
    add(0x80 | (code >> 12 & 0x3f));
    add(0x80 | (code >> 6 & 0x3f));
    add(0x80 | (code & 0x3f));
  }
}

class Parser {
 public:
  Parser(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  Json document() {
    Json value = read_value(0);
    skip_space();
    if (at_ < text_.size()) fail("something follows the end of the JSON value");
    return value;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError({file_, line_, static_cast<int>(at_ - line_start_) + 1}, message);
  }

  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }

  void skip_space() {
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '\n') {
        ++line_;
        line_start_ = at_ + 1;
      } else if (c != ' ' && c != '\t' && c != '\r') {
        return;
      }
    }
  }

  std::string found() const {
    return at_ < text_.size() ? "found " + quoted(text_.substr(at_, 1)) : std::string("the file ends here");
  }

  Json read_value(int depth) {
    if (depth > max_json_depth) fail("the JSON is nested deeper than " + std::to_string(max_json_depth) + " levels");
    skip_space();
    Json value;
    value.line = line_;
    value.column = static_cast<int>(at_ - line_start_) + 1;
    switch (peek()) {
      case '{':
        read_object(value, depth);
        break;
      case '[':
        read_array(value, depth);
        break;
      case '"':
        value.kind = JsonKind::string;
        value.string = read_string();
        break;
      default:
        read_word(value);
    }
    return value;
  }

  void read_object(Json& value, int depth) {
    value.kind = JsonKind::object;
    ++at_;
    skip_space();
    if (peek() == '}') {
      ++at_;
      return;
    }
    while (true) {
      skip_space();
      if (peek() != '"') fail("a name in double quotes is expected, " + found());
      std::string key = read_string();
      skip_space();
      if (peek() != ':') fail("a colon is expected after the name, " + found());
      ++at_;
      read_member(std::move(key), value, depth);
      if (!read_separator('}')) return;
    }
  }

  /// Application-specific data ("extras") are checked but not stored: they may have any size.
  void read_member(std::string&& key, Json& object, int depth) {
    if (key == "extras" || extras_ > 0) {
      ++extras_;
      read_value(depth + 1);
      --extras_;
      return;
    }
    if (object.keys.size() == max_names) fail("an object has over 4096 names, which none of glTF has");
    object.keys.push_back(std::move(key));
    object.items.push_back(read_value(depth + 1));
  }

  void read_array(Json& value, int depth) {
    value.kind = JsonKind::array;
    ++at_;
    skip_space();
    if (peek() == ']') {
      ++at_;
      return;
    }
    do {
      Json item = read_value(depth + 1);
      if (extras_ == 0) value.items.push_back(std::move(item));
    } while (read_separator(']'));
  }

  /// True after a comma, false after `end`.
  bool read_separator(char end) {
    skip_space();
    const char c = peek();
    if (c != ',' && c != end) fail(std::string("a comma or '") + end + "' is expected, " + found());
    ++at_;
    return c == ',';
  }

  void read_word(Json& value) {
    const size_t stop = std::min(text_.find_first_of(" \t\r\n,]}:\"[{", at_), text_.size());
    const std::string_view word = text_.substr(at_, stop - at_);
    if (word.empty()) fail("a value is expected, " + found());
    if (word == "true" || word == "false") {
      value.kind = JsonKind::boolean;
      value.boolean = word == "true";
    } else if (word != "null") {
      const bool may_be_number = (word[0] >= '0' && word[0] <= '9') || (word[0] == '-' && word.size() > 1);
      const std::optional<double> number = may_be_number ? parse_real(word) : std::nullopt;
      if (!number) fail("not a JSON value: " + quoted(word));
      if (!std::isfinite(*number)) fail("the number " + quoted(word) + " is too large");
      value.kind = JsonKind::number;
      value.number = *number;
    }
    at_ = stop;
  }

  uint32_t read_hex4() {
    uint32_t code = 0;
    for (int i = 0; i < 4; ++i, ++at_) {
      const char c = peek();
      const int digit = c >= '0' && c <= '9'   ? c - '0'
                        : c >= 'a' && c <= 'f' ? c - 'a' + 10
                        : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                               : -1;
      if (digit < 0) fail("four hexadecimal digits are expected after \\u, " + found());
      code = code << 4 | static_cast<uint32_t>(digit);
    }
    return code;
  }

  void read_escape(std::string& result) {
    const char c = peek();
    ++at_;
    switch (c) {
      case 'b':
        result += '\b';
        return;
      case 'f':
        result += '\f';
        return;
      case 'n':
        result += '\n';
        return;
      case 'r':
        result += '\r';
        return;
      case 't':
        result += '\t';
        return;
      case '"':
      case '\\':
      case '/':
        result += c;
        return;
      case 'u': {
        uint32_t code = read_hex4();
        if (code >= 0xd800 && code < 0xdc00 && text_.substr(at_, 2) == "\\u") {
          at_ += 2;
          const uint32_t low = read_hex4();
          code = low >= 0xdc00 && low < 0xe000 ? 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00) : 0xfffd;
        }
        append_utf8(result, code >= 0xd800 && code < 0xe000 ? 0xfffd : code);
        return;
      }
      default:
        --at_;
        fail("an unknown escape in a string, " + found());
    }
  }

  std::string read_string() {
    ++at_;
    std::string result;
    while (true) {
      size_t stop = at_;
      while (stop < text_.size() && text_[stop] != '"' && text_[stop] != '\\' &&
             static_cast<unsigned char>(text_[stop]) >= 0x20)
        ++stop;
      result.append(text_, at_, stop - at_);
      at_ = stop;
      if (at_ >= text_.size()) fail("the file ends within a string");
      if (text_[at_] == '"') {
        ++at_;
        return result;
      }
      if (text_[at_] != '\\') fail("a control character is not allowed in a string");
      ++at_;
      read_escape(result);
    }
  }

  std::string_view text_;
  const std::string& file_;
  size_t at_ = 0, line_start_ = 0;
  int line_ = 1;
  int extras_ = 0;  ///< number of "extras" objects that contain the current value
};

}  // namespace

const Json* Json::find(std::string_view key) const {
  for (size_t i = 0; i < keys.size(); ++i)
    if (keys[i] == key) return &items[i];
  return nullptr;
}

const Json& empty_object() {
  static const Json object = [] {
    Json empty;
    empty.kind = JsonKind::object;
    return empty;
  }();
  return object;
}

Json parse_json(std::string_view text, const std::string& file) { return Parser(text, file).document(); }

}  // namespace alhazen::impl::gltf

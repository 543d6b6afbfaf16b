#include "io/pbrt/lexer.h"

#include <algorithm>
#include <charconv>
#include <limits>
#include <utility>

namespace alhazen::pbrt {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

bool ends_word(char c) { return is_blank(c) || c == '"' || c == '[' || c == ']'; }

/// from_chars calls both 1e999 and 1e-999 out of range; only the first is an error.
bool is_underflow(std::string_view text) {
  const size_t exponent = text.find_first_of("eE");
  if (exponent != std::string_view::npos) return text.substr(exponent + 1, 1) == "-";
  const size_t digit = text.find_first_not_of("-0");
  return digit != std::string_view::npos && text[digit] == '.';
}

std::string_view without_plus(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

}  // namespace

Lexer::Lexer(std::shared_ptr<const SourceFile> source)
    : source_(std::move(source)),
      position_(source_->text.data()),
      end_(position_ + source_->text.size()),
      line_start_(position_) {
  const std::string_view text = source_->text;
  if (text.starts_with("\xfe\xff") || text.starts_with("\xff\xfe"))
    fail({source_, 1, 1}, "the file is encoded as UTF-16; save it as UTF-8");
  if (text.starts_with("\xef\xbb\xbf")) position_ += 3;
  scan();
}

Token Lexer::next() {
  const Token token = token_;
  scan();
  return token;
}

int Lexer::column_of(const char* position) const {
  return static_cast<int>(std::min<std::ptrdiff_t>(position - line_start_ + 1, std::numeric_limits<int>::max()));
}

void Lexer::skip_blanks() {
  for (; position_ < end_; ++position_) {
    if (*position_ == '\n') {
      ++line_;
      line_start_ = position_ + 1;
    } else if (*position_ == '#') {
      while (position_ + 1 < end_ && position_[1] != '\n' && position_[1] != '\r') ++position_;
    } else if (!is_blank(*position_)) {
      return;
    }
  }
}

void Lexer::scan() {
  skip_blanks();
  token_.line = line_;
  token_.column = column_of(position_);
  const char* start = position_;
  if (position_ == end_) {
    token_.kind = TokenKind::end;
  } else if (*position_ == '"') {
    scan_string();
    return;
  } else if (*position_ == '[' || *position_ == ']') {
    token_.kind = *position_++ == '[' ? TokenKind::open_bracket : TokenKind::close_bracket;
  } else {
    token_.kind = TokenKind::word;
    while (position_ < end_ && !ends_word(*position_)) ++position_;
  }
  token_.text = {start, static_cast<size_t>(position_ - start)};
}

void Lexer::scan_string() {
  const char* start = position_++;
  while (position_ < end_ && *position_ != '"' && *position_ != '\n') {
    if (*position_ == '\\' && position_ + 1 < end_ && position_[1] != '\n') ++position_;
    ++position_;
  }
  if (position_ == end_ || *position_ == '\n')
    fail(place(token_), "the string is not closed; put a \" at its end, on the same line");
  ++position_;
  token_.kind = TokenKind::string;
  token_.text = {start, static_cast<size_t>(position_ - start)};
}

std::string described(const Token& token) {
  if (token.kind == TokenKind::end) return "the end of the file";
  if (token.kind == TokenKind::string) return "the string " + std::string(token.text.substr(0, 40));
  return "\"" + std::string(token.text.substr(0, 40)) + "\"";
}

std::string unquoted(const Lexer& lexer, const Token& token) {
  const std::string_view inner = token.text.substr(1, token.text.size() - 2);
  if (inner.find('\\') == std::string_view::npos) return std::string(inner);
  constexpr std::string_view codes = "bfnrt\\'\"", characters = "\b\f\n\r\t\\'\"";
  std::string text;
  for (size_t i = 0; i < inner.size(); ++i) {
    if (inner[i] != '\\') {
      text += inner[i];
      continue;
    }
    const size_t code = ++i < inner.size() ? codes.find(inner[i]) : std::string_view::npos;
    if (code == std::string_view::npos)
      fail(lexer.place(token), "unknown escape in the string; write \\\\ for a backslash (or / in a path)");
    text += characters[code];
  }
  return text;
}

std::string expect_string(Lexer& lexer, const std::string& what) {
  const Token token = lexer.peek();
  if (token.kind != TokenKind::string)
    fail(lexer.place(token), "expected " + what + " in quotes, got " + described(token));
  lexer.next();
  return unquoted(lexer, token);
}

double number_of(const Lexer& lexer, const Token& token) {
  const std::string_view text = without_plus(token.text);
  double value = 0;
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  // from_chars also reads "inf" and "nan"; a number of the format has a digit.
  const bool spelled = token.kind != TokenKind::word || text.find_first_of("0123456789") == std::string_view::npos;
  if (spelled || end != last || error == std::errc::invalid_argument)
    fail(lexer.place(token), "expected a number, got " + described(token));
  if (error == std::errc::result_out_of_range) {
    if (is_underflow(text)) return 0;
    fail(lexer.place(token), "the number " + described(token) + " is too large for double precision");
  }
  return value;
}

int32_t integer_of(const Lexer& lexer, const Token& token) {
  const std::string_view text = without_plus(token.text);
  int32_t value = 0;
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (token.kind != TokenKind::word || end != last || error == std::errc::invalid_argument)
    fail(lexer.place(token), "expected an integer, got " + described(token));
  if (error == std::errc::result_out_of_range)
    fail(lexer.place(token), "the integer " + described(token) + " does not fit in 32 bits");
  return value;
}

}  // namespace alhazen::pbrt

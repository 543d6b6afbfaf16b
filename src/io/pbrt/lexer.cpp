#include "io/pbrt/lexer.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <limits>
#include <utility>

namespace alhazen::impl::pbrt {

namespace {

/// Limit on the decompressed bytes of one file, so that a small .gz file cannot occupy the machine for hours.
constexpr uint64_t max_text_bytes = uint64_t{8} << 30;

/// Bytes read at a time; less for smaller files, since scenes may include very many.
constexpr size_t window_size = size_t{1} << 18, min_window = 4096;

/// Longer than any name or path.
constexpr size_t max_token_size = size_t{1} << 20;

bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }

bool ends_word(char c) { return is_blank(c) || c == '"' || c == '[' || c == ']'; }

/// from_chars reports both 1e999 and 1e-999 as out of range; only the first is an error.
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
      bytes_(source_->open()),
      window_(std::clamp<size_t>(bytes_->plausible_size(), min_window, window_size)) {
  position_ = end_ = window_.data();
  while (end_ - position_ < 4 && refill()) {
  }
  const std::string_view text(position_, static_cast<size_t>(end_ - position_));
  if (text.starts_with("\xfe\xff") || text.starts_with("\xff\xfe"))
    fail({source_, 1, 1}, "the file is encoded as UTF-16; save it as UTF-8");
  if (text.find('\0') != std::string_view::npos)
    fail({source_, 1, 1}, "the file is binary, not the text of a pbrt scene; give the scene file itself");
  if (text.starts_with("\xef\xbb\xbf")) position_ += 3;
  scan();
}

Token Lexer::next() {
  returned_ = token_;
  scan();
  return returned_;
}

int Lexer::column_of(const char* position) const {
  return static_cast<int>(
      std::min<int64_t>(position - window_.data() + column_offset_, std::numeric_limits<int>::max()));
}

int Lexer::line() const { return static_cast<int>(std::min<int64_t>(line_, std::numeric_limits<int>::max())); }

bool Lexer::more() { return position_ < end_ || refill(); }

/// Copies the text of the token that the caller holds before the window moves.
void Lexer::keep_returned_token() {
  const bool is_in_window = returned_.text.data() >= window_.data() && returned_.text.data() < end_;
  if (returned_.text.empty() || !is_in_window) return;
  returned_text_ = returned_.text;
  returned_.text = returned_text_;
}

/// Reads more text from `position_`, the end of the window. Returns false at the end of the text.
bool Lexer::refill() {
  keep_returned_token();
  const char* const kept_from = token_start_ ? token_start_ : position_;
  const size_t moved = static_cast<size_t>(kept_from - window_.data()), kept = static_cast<size_t>(end_ - kept_from);
  if (kept > max_token_size)
    fail({source_, token_.line, token_.column},
         "a word or string of over 1 MiB is too long; is a quotation mark or a blank missing?");
  std::memmove(window_.data(), kept_from, kept);
  column_offset_ += static_cast<int64_t>(moved);
  position_ -= moved;
  end_ -= moved;
  if (token_start_) token_start_ = window_.data();
  if (window_.size() - kept < window_.size() / 2) {
    const std::ptrdiff_t at = position_ - window_.data();
    window_.resize(2 * window_.size());
    position_ = window_.data() + at;
    end_ = window_.data() + kept;
    if (token_start_) token_start_ = window_.data();
  }
  const size_t count = bytes_->read(window_.data() + kept, window_.size() - kept);
  end_ += count;
  bytes_read_ += count;
  if (bytes_read_ > max_text_bytes)
    throw InputError({source_->name}, "holds over 8 GiB of text; store its meshes as PLY");
  return count > 0;
}

void Lexer::skip_comment() {
  while (more()) {
    const size_t count = static_cast<size_t>(end_ - position_);
    const void* feed = std::memchr(position_, '\n', count);
    const char* stop = feed ? static_cast<const char*>(feed) : end_;
    const void* carriage = std::memchr(position_, '\r', static_cast<size_t>(stop - position_));
    if (carriage) stop = static_cast<const char*>(carriage);
    position_ = stop;
    if (stop < end_) return;
  }
}

void Lexer::skip_blanks() {
  while (more()) {
    const char c = *position_;
    if (c == '#') {
      skip_comment();
      continue;
    }
    if (!is_blank(c)) return;
    ++position_;
    if (c == '\n') {
      ++line_;
      column_offset_ = 1 - (position_ - window_.data());
    }
  }
}

void Lexer::scan() {
  token_start_ = nullptr;
  skip_blanks();
  token_.line = line();
  token_.column = column_of(position_);
  token_start_ = position_;
  if (position_ == end_) {
    token_.kind = TokenKind::end;
  } else if (*position_ == '"') {
    scan_string();
  } else if (*position_ == '[' || *position_ == ']') {
    token_.kind = *position_++ == '[' ? TokenKind::open_bracket : TokenKind::close_bracket;
  } else {
    scan_word();
  }
  token_.text = {token_start_, static_cast<size_t>(position_ - token_start_)};
}

void Lexer::scan_word() {
  token_.kind = TokenKind::word;
  do {
    while (position_ < end_ && !ends_word(*position_)) ++position_;
  } while (position_ == end_ && refill());
}

void Lexer::scan_string() {
  token_.kind = TokenKind::string;
  ++position_;
  while (more() && *position_ != '"' && *position_ != '\n') {
    const bool escapes = *position_++ == '\\';
    if (escapes && more() && *position_ != '\n') ++position_;
  }
  if (position_ == end_ || *position_ == '\n')
    fail(place(token_), "the string is not closed; put a \" at its end, on the same line");
  ++position_;
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
  return unquoted(lexer, lexer.next());
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

}  // namespace alhazen::impl::pbrt

#pragma once

// Splits a scene text into tokens as it is read. Only this part of the reader converts characters to numbers.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/pbrt/source.h"

namespace alhazen::impl::pbrt {

enum class TokenKind { end, word, string, open_bracket, close_bracket };

struct Token {
  TokenKind kind = TokenKind::end;
  std::string_view text;  ///< as in the source, including the quotes of a string
  int line = 1;
  int column = 1;
};

/// Holds a window of the text, so that memory does not grow with the file.
class Lexer {
 public:
  explicit Lexer(std::shared_ptr<const SourceFile> source);
  Lexer(const Lexer&) = delete;
  Lexer& operator=(const Lexer&) = delete;

  /// The next token. Its text is valid until `next` is called.
  const Token& peek() const { return token_; }
  /// Advances past it. The text of the returned token is valid until `next` is called again.
  Token next();
  Place place(const Token& token) const { return {source_, token.line, token.column}; }

 private:
  void skip_blanks();
  void skip_comment();
  void scan();
  void scan_word();
  void scan_string();
  bool more();
  bool refill();
  void keep_returned_token();
  int column_of(const char* position) const;
  int line() const;

  std::shared_ptr<const SourceFile> source_;
  std::unique_ptr<ByteSource> bytes_;
  uint64_t bytes_read_ = 0;
  std::vector<char> window_;
  const char* position_ = nullptr;
  const char* end_ = nullptr;
  const char* token_start_ = nullptr;  ///< start of what must remain in the window; null between tokens
  int64_t line_ = 1;
  int64_t column_offset_ = 1;  ///< the column of a position is this plus its distance from the window's start
  Token token_;
  Token returned_;
  std::string returned_text_;  ///< of `returned_`, once the window has moved past it
};

/// The token as it appears in messages: `"text"`, shortened, or `the end of the file`.
std::string described(const Token& token);

/// The characters of a string token, with escapes resolved.
std::string unquoted(const Lexer& lexer, const Token& token);

/// Reads the next token, which must be a string. `what` describes it in the message.
std::string expect_string(Lexer& lexer, const std::string& what);

/// The value of a number token. It is always finite: the format has no infinity and no NaN.
double number_of(const Lexer& lexer, const Token& token);

/// The value of an integer token, within 32 bits.
int32_t integer_of(const Lexer& lexer, const Token& token);

}  // namespace alhazen::impl::pbrt

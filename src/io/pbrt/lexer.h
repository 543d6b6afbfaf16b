#pragma once

// Cuts a scene text into tokens. The only place of the reader that turns characters into numbers.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "io/pbrt/source.h"

namespace alhazen::pbrt {

enum class TokenKind { end, word, string, open_bracket, close_bracket };

struct Token {
  TokenKind kind = TokenKind::end;
  std::string_view text;  ///< as it stands in the source, with the quotes of a string
  int line = 1;
  int column = 1;
};

class Lexer {
 public:
  explicit Lexer(std::shared_ptr<const SourceFile> source);

  const Token& peek() const { return token_; }
  Token next();
  Place place(const Token& token) const { return {source_, token.line, token.column}; }

 private:
  void skip_blanks();
  void scan();
  void scan_string();
  int column_of(const char* position) const;

  std::shared_ptr<const SourceFile> source_;
  const char* position_;
  const char* end_;
  const char* line_start_;
  int line_ = 1;
  Token token_;
};

/// The token as a message names it: `"text"`, shortened, or `the end of the file`.
std::string described(const Token& token);

/// The characters of a string token with its escapes resolved.
std::string unquoted(const Lexer& lexer, const Token& token);

/// The next token, which must be a string. `what` names it in the message.
std::string expect_string(Lexer& lexer, const std::string& what);

/// The value of a number token. It is always finite: the format has no infinity and no NaN.
double number_of(const Lexer& lexer, const Token& token);

/// The value of an integer token, within 32 bits.
int32_t integer_of(const Lexer& lexer, const Token& token);

}  // namespace alhazen::pbrt

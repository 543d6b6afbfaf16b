#pragma once

// Texts of words in lines, as OBJ and MTL files have them.

#include <string>
#include <string_view>
#include <vector>

#include "files/byte_source.h"
#include "util/diagnostics.h"

namespace alhazen::impl::obj {

struct Word {
  std::string_view text;
  int column = 0;  ///< in bytes, from 1; of continued lines, as if they were one
};

/// Reads line by line. A backslash at the end of a line continues it. `#` begins a comment at the start of a line, and
/// also at that of a word where the arguments are numbers: names may have it, as `Material #25` of 3ds Max.
class Lines {
 public:
  Lines(ByteSource& source, std::string name) : source_(source), name_(std::move(name)) {}

  /// Returns false at the end. Lines without words are skipped.
  bool next();
  const std::vector<Word>& words() const { return words_; }
  /// The text from word `first` to the end of the line, without blanks at its ends.
  std::string_view rest(size_t first) const;

  const std::string& name() const { return name_; }
  SourceLocation place(size_t word = 0) const;
  [[noreturn]] void fail(size_t word, const std::string& message) const;
  /// A finite number. Throws if there is no such word.
  double number(size_t word) const;

 private:
  bool read_line();
  void split_line();

  ByteSource& source_;
  std::string name_, line_, buffer_;
  size_t at_ = 0;  ///< in the buffer
  int number_ = 0, lines_read_ = 0;
  std::vector<Word> words_;
};

}  // namespace alhazen::impl::obj

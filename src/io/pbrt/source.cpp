#include "io/pbrt/source.h"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <vector>

#include "util/printable.h"

namespace alhazen::impl::pbrt {

namespace {

/// Length of the excerpt in bytes; lines of generated files may have megabytes.
constexpr uint64_t excerpt_width = 100;

/// A part of a line, and the number of its bytes before the caret.
struct Excerpt {
  std::string text;
  size_t caret = 0;
};

/// Reads through the text once, however long it is, and keeps the part of the line to show.
Excerpt find_excerpt(ByteSource& source, int line, uint64_t caret) {
  const uint64_t begin = caret > excerpt_width / 2 ? caret - excerpt_width / 2 : 0;
  Excerpt excerpt;
  excerpt.caret = static_cast<size_t>(caret - begin);
  std::vector<char> chunk(size_t{1} << 18);
  int at_line = 1;
  uint64_t column = 0;  // of the next byte in its line, from 0
  while (const size_t count = source.read(chunk.data(), chunk.size())) {
    std::string_view left(chunk.data(), count);
    while (!left.empty()) {
      const size_t end = left.find('\n');
      const std::string_view part = left.substr(0, end);
      if (at_line == line && begin < column + part.size()) {
        const size_t skipped = begin > column ? static_cast<size_t>(begin - column) : 0;
        excerpt.text += part.substr(skipped, static_cast<size_t>(excerpt_width) - excerpt.text.size());
      }
      column += part.size();
      if (at_line == line && (end != std::string_view::npos || excerpt.text.size() == excerpt_width)) return excerpt;
      if (end == std::string_view::npos) break;
      left.remove_prefix(end + 1);
      ++at_line;
      column = 0;
    }
  }
  return excerpt;
}

std::string excerpt_at(const Place& place) {
  if (!place.source || place.line <= 0) return {};
  Excerpt excerpt;
  try {
    excerpt =
        find_excerpt(*place.source->open(), place.line, place.column > 0 ? static_cast<uint64_t>(place.column - 1) : 0);
  } catch (const InputError&) {
    return {};  // the file is gone or damaged: the original error is reported without an excerpt
  }
  if (excerpt.text.empty() || excerpt.caret > excerpt.text.size()) return {};
  size_t columns = 0, all = 0;
  printable_columns(std::string_view(excerpt.text).substr(0, excerpt.caret), columns);
  const std::string number = std::to_string(place.line);
  return " " + number + " | " + printable_columns(excerpt.text, all) + "\n " + std::string(number.size(), ' ') + " | " +
         std::string(columns, ' ') + "^";
}

}  // namespace

std::unique_ptr<ByteSource> SourceFile::open() const {
  if (file) return std::make_unique<FileSource>(*file);
  return std::make_unique<MemorySource>(text);
}

SourceLocation Place::location() const { return {source ? source->name : std::string(), line, column}; }

InputError error_at(const Place& place, const std::string& message) {
  return InputError(place.location(), message, excerpt_at(place));
}

void fail(const Place& place, const std::string& message) { throw error_at(place, message); }

}  // namespace alhazen::impl::pbrt

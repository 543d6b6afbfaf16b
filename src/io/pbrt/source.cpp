#include "io/pbrt/source.h"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

namespace alhazen::pbrt {

namespace {

/// Decompressed bytes that one file may hold: what a small .gz can grow to must not take the machine down.
constexpr size_t max_text_bytes = size_t{8} << 30;

/// Characters of the excerpt; lines of generated files run to megabytes.
constexpr size_t excerpt_width = 100;

std::string_view line_of(const std::string& text, int line) {
  size_t begin = 0;
  for (int i = 1; i < line; ++i) {
    const size_t end = text.find('\n', begin);
    if (end == std::string::npos) return {};
    begin = end + 1;
  }
  if (begin > text.size()) return {};
  const size_t end = text.find('\n', begin);
  return std::string_view(text).substr(begin, end == std::string::npos ? end : end - begin);
}

std::string excerpt_at(const Place& place) {
  if (!place.source || place.line <= 0 || place.source->text.empty()) return {};
  const std::string_view line = line_of(place.source->text, place.line);
  const size_t caret = place.column > 0 ? static_cast<size_t>(place.column - 1) : 0;
  if (line.empty() || caret > line.size()) return {};
  const bool is_cut = line.size() > excerpt_width && caret > excerpt_width / 2;
  const size_t begin = is_cut ? caret - excerpt_width / 2 : 0;
  std::string shown(line.substr(begin, excerpt_width));
  for (char& c : shown)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  const std::string number = std::to_string(place.line);
  return " " + number + " | " + shown + "\n " + std::string(number.size(), ' ') + " | " +
         std::string(caret - begin, ' ') + "^";
}

struct GzipFile {
  gzFile handle;
  explicit GzipFile(const std::string& path) : handle(gzopen(path.c_str(), "rb")) {}
  ~GzipFile() {
    if (handle) gzclose_r(handle);
  }
  GzipFile(const GzipFile&) = delete;
  GzipFile& operator=(const GzipFile&) = delete;
};

}  // namespace

SourceLocation Place::location() const { return {source ? source->name : std::string(), line, column}; }

InputError error_at(const Place& place, const std::string& message) {
  return InputError(place.location(), message, excerpt_at(place));
}

void fail(const Place& place, const std::string& message) { throw error_at(place, message); }

std::string read_text(const std::string& path) {
  const SourceLocation where{path, 0, 0};
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw InputError(where, "is a folder; give the name of a scene file");
  errno = 0;
  // zlib hands plain files through unchanged, so one way of reading serves both.
  GzipFile file(path);
  if (!file.handle) throw InputError(where, std::string("cannot be opened: ") + std::strerror(errno));
  gzbuffer(file.handle, 1u << 18);

  std::string text;
  const auto size = std::filesystem::file_size(path, error);
  if (!error) text.reserve(static_cast<size_t>(std::min<std::uintmax_t>(size, max_text_bytes)));
  std::vector<char> chunk(size_t{1} << 20);
  while (true) {
    const int got = gzread(file.handle, chunk.data(), static_cast<unsigned>(chunk.size()));
    if (got < 0) {
      int code = Z_OK;
      const char* reason = gzerror(file.handle, &code);
      throw InputError(where, std::string("cannot be read: ") + (code == Z_ERRNO ? std::strerror(errno) : reason));
    }
    if (got == 0) break;
    text.append(chunk.data(), static_cast<size_t>(got));
    if (text.size() > max_text_bytes) throw InputError(where, "holds over 8 GiB of text; store its meshes as PLY");
  }
  int code = Z_OK;
  gzerror(file.handle, &code);
  if (code == Z_BUF_ERROR) throw InputError(where, "ends in the middle of its gzip data; it was not copied whole");
  return text;
}

}  // namespace alhazen::pbrt

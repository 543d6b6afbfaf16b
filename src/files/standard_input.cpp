#include "files/standard_input.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "util/diagnostics.h"

namespace alhazen::impl {

namespace {

std::string read_all() {
  if (::isatty(STDIN_FILENO))
    throw InputError("the scene '-' is read from standard input, which is a terminal: redirect a file or a pipe to it");
  std::string text;
  std::array<char, 1 << 16> buffer;
  while (true) {
    const ssize_t count = ::read(STDIN_FILENO, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw InputError(std::string("standard input cannot be read: ") + std::strerror(errno));
    if (count == 0) break;
    text.append(buffer.data(), static_cast<size_t>(count));
  }
  if (text.empty()) throw InputError("standard input is empty: write a pbrt scene to it");
  if (text.starts_with("glTF") || text.starts_with("ply\n") || text.starts_with("\x1f\x8b"))
    throw InputError("standard input is read as a pbrt scene, as text: give other files by their names");
  return text;
}

}  // namespace

const std::string& standard_input() {
  static const std::string text = read_all();
  return text;
}

}  // namespace alhazen::impl

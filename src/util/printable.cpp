#include "util/printable.h"

#include <array>
#include <cstdint>
#include <cstdio>
#include <utility>

namespace alhazen::impl {

namespace {

/// A character of UTF-8 text; for an invalid byte `size` is 1 and `valid` false.
struct Character {
  uint32_t code = 0;
  size_t size = 1;
  bool valid = false;
};

/// The smallest code point for a sequence of each length; overlong encodings are invalid (RFC 3629).
constexpr std::array<uint32_t, 5> smallest_code{0, 0, 0x80, 0x800, 0x10000};

Character decode(std::string_view text) {
  const auto byte = [&](size_t i) { return static_cast<uint32_t>(static_cast<unsigned char>(text[i])); };
  const uint32_t first = byte(0);
  if (first < 0x80) return {first, 1, true};
  const size_t size = first >= 0xf0 && first < 0xf8 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first >= 0xf8 || size > text.size()) return {first, 1, false};
  uint32_t code = first & (0x7fu >> size);
  for (size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return {first, 1, false};
    code = code << 6 | (byte(i) & 0x3f);
  }
  if (code < smallest_code[size] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return {first, 1, false};
  return {code, size, true};
}

/// Characters of Unicode's categories Cc, Zl, Zp, and those of Cf that reorder or hide text. U+200C and U+200D are
/// excepted, since some scripts need them within words.
bool acts_on_terminal(uint32_t code) {
  constexpr std::array<std::pair<uint32_t, uint32_t>, 12> ranges{{{0x00, 0x1f},
                                                                  {0x7f, 0x9f},
                                                                  {0xad, 0xad},
                                                                  {0x61c, 0x61c},
                                                                  {0x180e, 0x180e},
                                                                  {0x200b, 0x200b},
                                                                  {0x200e, 0x200f},
                                                                  {0x2028, 0x202e},
                                                                  {0x2060, 0x206f},
                                                                  {0xfeff, 0xfeff},
                                                                  {0xfff9, 0xfffb},
                                                                  {0xe0000, 0xe007f}}};
  for (const auto& [first, last] : ranges)
    if (code >= first && code <= last) return true;
  return false;
}

std::string escape_of(const Character& c) {
  if (c.code == '\n') return "\\n";
  if (c.code == '\t') return "\\t";
  std::array<char, 16> text{};
  const char* format = !c.valid || c.code < 0x80 ? "\\x%02x" : c.code < 0x10000 ? "\\u%04x" : "\\U%08x";
  // The format is one of three literals above.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
  std::snprintf(text.data(), text.size(), format, static_cast<unsigned>(c.code));
#pragma GCC diagnostic pop
  return text.data();
}

/// Passes each character that must not be shown to `replace`, and appends the result.
template <class Replace>
std::string replaced(std::string_view text, size_t& count, Replace replace) {
  std::string result;
  result.reserve(text.size());
  count = 0;
  while (!text.empty()) {
    const Character c = decode(text);
    if (c.valid && !acts_on_terminal(c.code))
      result += text.substr(0, c.size);
    else
      result += replace(c);
    text.remove_prefix(c.size);
    ++count;
  }
  return result;
}

}  // namespace

std::string printable(std::string_view text) {
  size_t count = 0;
  return replaced(text, count, escape_of);
}

std::string printable_lines(std::string_view text) {
  size_t count = 0;
  return replaced(text, count, [](const Character& c) { return c.code == '\n' ? std::string("\n") : escape_of(c); });
}

std::string printable_columns(std::string_view text, size_t& columns) {
  return replaced(text, columns, [](const Character& c) { return std::string(c.code == '\t' ? " " : "?"); });
}

}  // namespace alhazen::impl

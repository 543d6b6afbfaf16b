#pragma once

// Quotes parts of the input in messages.

#include <algorithm>
#include <string>
#include <string_view>

#include "util/printable.h"

namespace alhazen::impl {

/// Returns `text` in single quotes, cut after 40 bytes at a character boundary; characters that act on a terminal are
/// escaped.
inline std::string quoted(std::string_view text) {
  constexpr size_t longest = 40;
  size_t size = std::min(longest, text.size());
  const auto is_within_character = [&] { return (static_cast<unsigned char>(text[size]) & 0xc0) == 0x80; };
  if (size < text.size())
    while (size > longest - 3 && is_within_character()) --size;
  return "'" + printable(text.substr(0, size)) + (size < text.size() ? "...'" : "'");
}
// Found before the templates std::quoted, which <filesystem> brings.
inline std::string quoted(const std::string& text) { return quoted(std::string_view(text)); }
inline std::string quoted(std::string& text) { return quoted(std::string_view(text)); }

}  // namespace alhazen::impl

#pragma once

// Pieces of input as they appear in messages.

#include <string>
#include <string_view>

namespace alhazen {

/// `text` in single quotes, cut after 40 bytes; bytes that a terminal might take for commands become `?`.
inline std::string quoted(std::string_view text) {
  constexpr size_t longest = 40;
  std::string result = "'";
  for (const char c : text.substr(0, longest)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > longest ? "...'" : "'");
}

}  // namespace alhazen

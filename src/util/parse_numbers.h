#pragma once

// Numbers in the values of options: `800x600`, `0,0.5,0,1`.

#include <array>
#include <charconv>
#include <string_view>
#include <system_error>

namespace alhazen {

/// Parses exactly `count` numbers with `separator` between them. Returns false if the text is anything else.
template <class Number, size_t count>
bool parse_numbers(std::string_view text, char separator, std::array<Number, count>& values) {
  const char* at = text.data();
  const char* const end = at + text.size();
  if (at != end && *at == '+') ++at;
  for (size_t i = 0; i < count; ++i) {
    const auto [next, error] = std::from_chars(at, end, values[i]);
    const bool is_last = i + 1 == count;
    if (error != std::errc() || (is_last ? next != end : next == end || *next != separator)) return false;
    at = is_last ? next : next + 1;
  }
  return true;
}

}  // namespace alhazen

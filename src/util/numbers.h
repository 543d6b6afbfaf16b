#pragma once

// Parses numbers in text files, independently of the locale; the whole text must be a number.

#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

namespace alhazen::impl {

/// A leading plus sign is common in text files, but std::from_chars does not accept it.
inline std::string_view without_plus(std::string_view text) {
  const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+';
  return plus ? text.substr(1) : text;
}

/// Parses the whole of `text` as a number. Returns nothing if it is not one. `nan` and `inf` are numbers. Numbers too
/// large for a double become infinity, numbers too small become zero.
inline std::optional<double> parse_real(std::string_view text) {
  text = without_plus(text);
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (stop != end || error == std::errc::invalid_argument) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    const bool too_small = text.find("e-") != text.npos || text.find("E-") != text.npos;
    value = too_small ? 0 : std::numeric_limits<double>::infinity();
    return text[0] == '-' ? -value : value;
  }
  return value;
}

/// Parses the whole of `text` as an integer. Returns nothing if it is not one or does not fit.
inline std::optional<int64_t> parse_integer(std::string_view text) {
  text = without_plus(text);
  int64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (stop != end || error != std::errc()) return std::nullopt;
  return value;
}

}  // namespace alhazen::impl

#pragma once

// Numbers in the values of options: `800x600`, `0,0.5,0,1`, `1e3`, `90s`.

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <utility>

namespace alhazen::impl {

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

/// Parses one number. An integer may be written with an exponent, 1e3, if it is one.
template <class Number>
bool parse_number(std::string_view text, Number& value) {
  std::array<Number, 1> parsed;
  if (parse_numbers(text, '\0', parsed)) {
    value = parsed[0];
    return true;
  }
  if constexpr (std::is_integral_v<Number>) {
    constexpr double exact = 9007199254740992;  // 2^53: integers up to it are doubles
    std::array<double, 1> wide;
    if (parse_numbers(text, '\0', wide) && std::abs(wide[0]) <= exact && std::trunc(wide[0]) == wide[0] &&
        wide[0] >= static_cast<double>(std::numeric_limits<Number>::lowest()) &&
        wide[0] <= static_cast<double>(std::numeric_limits<Number>::max())) {
      value = static_cast<Number>(wide[0]);
      return true;
    }
  }
  return false;
}

/// Parses a time in seconds, or with a unit: 10s, 5min, 1.5h.
inline bool parse_seconds(std::string_view text, double& seconds) {
  constexpr std::pair<std::string_view, double> units[] = {{"min", 60}, {"s", 1}, {"m", 60}, {"h", 3600}};
  double factor = 1;
  for (const auto& [unit, value] : units)
    if (text.size() > unit.size() && text.ends_with(unit)) {
      text.remove_suffix(unit.size());
      factor = value;
      break;
    }
  if (!parse_number(text, seconds)) return false;
  seconds *= factor;
  return true;
}

}  // namespace alhazen::impl

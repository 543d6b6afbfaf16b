#pragma once

// The distance of two numbers, as the number of representable steps between them.

#include <bit>
#include <cstdint>
#include <limits>

namespace alhazen::impl::test {

inline uint64_t ulps_between(double a, double b) {
  const int64_t i = std::bit_cast<int64_t>(a), j = std::bit_cast<int64_t>(b);
  if ((i < 0) != (j < 0)) return a == b ? 0 : std::numeric_limits<uint64_t>::max();
  return static_cast<uint64_t>(i > j ? i - j : j - i);
}

inline uint64_t ulps_between(float a, float b) {
  const int32_t i = std::bit_cast<int32_t>(a), j = std::bit_cast<int32_t>(b);
  if ((i < 0) != (j < 0)) return a == b ? 0 : std::numeric_limits<uint64_t>::max();
  return static_cast<uint64_t>(i > j ? i - j : j - i);
}

}  // namespace alhazen::impl::test

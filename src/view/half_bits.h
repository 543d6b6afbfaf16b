#pragma once

// Half precision (IEEE 754 binary16), without branches, so that compilers convert several values at once.

#include <bit>
#include <cstdint>

namespace alhazen::impl {

/// The bits of the nearest half, of two equally near ones of the even one. What is too large becomes infinite, and NaN
/// stays NaN.
inline uint16_t half_bits(float value) {
  constexpr uint32_t smallest_normal = 0x38800000;  // 2^-14
  constexpr uint32_t first_infinite = 0x477ff000;   // 65520, halfway from the largest half to the next power of two
  constexpr uint32_t infinity = 0x7f800000;
  const uint32_t bits = std::bit_cast<uint32_t>(value), magnitude = bits & 0x7fffffff;
  // The exponent's bias becomes 15, and 13 bits of the fraction are rounded away, up into the exponent if need be.
  const uint32_t normal = (magnitude - 0x38000000 + 0xfff + ((magnitude >> 13) & 1)) >> 13;
  // Next to 1/2 floats are 2^-24 apart, as halves that are not normal: the addition rounds.
  const uint32_t subnormal = std::bit_cast<uint32_t>(std::bit_cast<float>(magnitude) + 0.5f) - 0x3f000000;
  uint32_t half = magnitude < smallest_normal ? subnormal : normal;
  half = magnitude >= first_infinite ? 0x7c00 : half;
  half = magnitude > infinity ? 0x7e00 : half;
  return static_cast<uint16_t>(half | ((bits >> 16) & 0x8000));
}

}  // namespace alhazen::impl

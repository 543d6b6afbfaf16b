#pragma once

// Integer hashes: pure functions from which every random number comes.

#include <cstdint>

#include "core/math/platform.h"

namespace ALHAZEN_CORE {

/// A bijection of 64 bits in which every input bit reaches every output bit (Stafford 2011, "Better Bit Mixing", mix
/// 13).
ALHAZEN_HD constexpr uint64_t mix64(uint64_t x) {
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9u;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebu;
  x ^= x >> 31;
  return x;
}

/// A bijection of 32 bits with low bias (Wellons 2018, "Prospecting for Hash Functions": lowbias32).
ALHAZEN_HD constexpr uint32_t mix32(uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}

ALHAZEN_HD constexpr uint32_t combine32(uint32_t seed, uint32_t value) {
  return mix32(seed ^ mix32(value + 0x9e3779b9u));
}

ALHAZEN_HD constexpr uint32_t reverse_bits(uint32_t x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
#if defined(__GNUC__) && !defined(__CUDA_ARCH__)
  return __builtin_bswap32(x);
#else
  return (x >> 24) | ((x >> 8) & 0xff00u) | ((x & 0xff00u) << 8) | (x << 24);
#endif
}

/// 32 random bits as a number in [0, 1). Float keeps the 24 high bits.
template <class Real>
ALHAZEN_HD constexpr Real unit_interval(uint32_t bits) {
  if constexpr (sizeof(Real) == sizeof(float))
    return static_cast<Real>(bits >> 8) * static_cast<Real>(0x1p-24);
  else
    return static_cast<Real>(bits) * static_cast<Real>(0x1p-32);
}

}  // namespace ALHAZEN_CORE

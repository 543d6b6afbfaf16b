#pragma once

// Permutes eight lanes, and compacts the selected ones, without data-dependent branches.

#include <bit>

#include "core/simd/lanes.h"

namespace ALHAZEN_CORE {

/// Lane i of the result is lane from[i].
ALHAZEN_INLINE Lanes<float, 8> permuted(const Lanes<float, 8>& a, const uint32_t (&from)[8]) {
#if defined(__AVX2__)
  const __m256i order = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
  Lanes<float, 8> b;
  b.r[0] = (Lanes<float, 8>::Register)_mm256_permutevar8x32_ps((__m256)a.r[0], order);
  return b;
#else
  float lanes[8], other[8];
  a.store(lanes);
  for (int i = 0; i < 8; ++i) other[i] = lanes[from[i]];
  return Lanes<float, 8>::load(other);
#endif
}

/// The same for eight numbers in memory.
ALHAZEN_INLINE void permute(const uint32_t (&lanes)[8], const uint32_t (&from)[8], uint32_t (&to)[8]) {
#if defined(__AVX2__)
  const __m256i order = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
  const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(lanes));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_permutevar8x32_epi32(all, order));
#else
  for (int i = 0; i < 8; ++i) to[i] = lanes[from[i]];
#endif
}

#if defined(__AVX2__) && !defined(__AVX512VL__)
/// The lane numbers of each set of lanes, in order, in 4 bits each.
struct SetLaneNumbers {
  uint32_t of[256];
};

inline constexpr SetLaneNumbers set_lane_numbers = [] {
  SetLaneNumbers numbers{};
  for (uint32_t set = 0; set < 256; ++set)
    for (uint32_t lane = 0, count = 0; lane < 8; ++lane)
      if (set >> lane & 1) numbers.of[set] |= lane << (4 * count++);
  return numbers;
}();

ALHAZEN_INLINE __m256i set_lanes(uint32_t set) {
  const __m256i shifts = _mm256_setr_epi32(0, 4, 8, 12, 16, 20, 24, 28);
  return _mm256_srlv_epi32(_mm256_set1_epi32(static_cast<int>(set_lane_numbers.of[set])), shifts);
}
#endif

/// Stores the selected lanes contiguously, in order. All 8 elements from `to` on may be written.
template <class T>
ALHAZEN_INLINE void store_set_lanes(const T (&lanes)[8], uint32_t set, T* to) {
  static_assert(sizeof(T) == 4);
#if defined(__AVX512VL__)
  const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(lanes));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_maskz_compress_epi32(static_cast<__mmask8>(set), all));
#elif defined(__AVX2__)
  const __m256i all = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(lanes));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_permutevar8x32_epi32(all, set_lanes(set)));
#else
  for (; set != 0; set &= set - 1) *to++ = lanes[std::countr_zero(set)];
#endif
}

}  // namespace ALHAZEN_CORE

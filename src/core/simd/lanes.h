#pragma once

// The one SIMD type: a fixed number of lanes in as many registers as the instruction set needs. Arithmetic uses GCC's
// vector extensions, whose operators round as scalar ones do; intrinsics supply what they lack. It is compiled once per
// instruction set (render/kernels/), and not for GPUs.

#include <cmath>
#include <cstdint>
#include <type_traits>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include "core/math/platform.h"

namespace ALHAZEN_CORE {

/// Register size in bytes for which these instructions run at full speed.
#if defined(__AVX512F__)
inline constexpr int max_register_bytes = 64;
#elif defined(__AVX__)
inline constexpr int max_register_bytes = 32;
#else
inline constexpr int max_register_bytes = 16;
#endif

template <class T, int count>
struct Lanes {
  using Component = T;
  static constexpr int bytes = count * static_cast<int>(sizeof(T));
  static constexpr int register_bytes = bytes < max_register_bytes ? bytes : max_register_bytes;
  static constexpr int registers = bytes / register_bytes;
  static constexpr int per_register = count / registers;
  typedef T Register __attribute__((vector_size(register_bytes)));

  typedef std::conditional_t<sizeof(T) == sizeof(float), int32_t, int64_t> Integer;
  typedef Integer Integers __attribute__((vector_size(register_bytes)));

  Register r[registers];

  ALHAZEN_INLINE static Lanes load(const T* from) {
    Lanes a;
    __builtin_memcpy(&a, from, sizeof(a));
    return a;
  }
  ALHAZEN_INLINE void store(T* to) const { __builtin_memcpy(to, r, sizeof(*this)); }
  ALHAZEN_INLINE T lane(int i) const { return r[i / per_register][i % per_register]; }
  ALHAZEN_INLINE static Lanes all(T x) {
    return map([&](int) { return x - Register{}; });
  }

  template <class Function>
  ALHAZEN_INLINE static Lanes map(const Function& function) {
    Lanes a;
    for (int i = 0; i < registers; ++i) a.r[i] = function(i);
    return a;
  }

  ALHAZEN_INLINE friend Lanes operator+(const Lanes& a, const Lanes& b) {
    return map([&](int i) { return a.r[i] + b.r[i]; });
  }
  ALHAZEN_INLINE friend Lanes operator-(const Lanes& a, const Lanes& b) {
    return map([&](int i) { return a.r[i] - b.r[i]; });
  }
  ALHAZEN_INLINE friend Lanes operator*(const Lanes& a, const Lanes& b) {
    return map([&](int i) { return a.r[i] * b.r[i]; });
  }
  ALHAZEN_INLINE friend Lanes operator/(const Lanes& a, const Lanes& b) {
    return map([&](int i) { return a.r[i] / b.r[i]; });
  }

  /// The smaller of each pair of lanes; b's if one is NaN.
  ALHAZEN_INLINE friend Lanes min(const Lanes& a, const Lanes& b) {
    return map([&](int i) { return a.r[i] < b.r[i] ? a.r[i] : b.r[i]; });
  }
  ALHAZEN_INLINE friend Lanes max(const Lanes& a, const Lanes& b) {
    return map([&](int i) { return a.r[i] > b.r[i] ? a.r[i] : b.r[i]; });
  }
  ALHAZEN_INLINE friend Lanes magnitude(const Lanes& a) {
    return map([&](int i) { return (Register)((Integers)a.r[i] & ~((Integers)(-Register{}))); });
  }
  /// x where a < b, else y.
  ALHAZEN_INLINE friend Lanes where_less(const Lanes& a, const Lanes& b, const Lanes& x, const Lanes& y) {
    return map([&](int i) { return a.r[i] < b.r[i] ? x.r[i] : y.r[i]; });
  }

  /// a in the lanes whose bits are set, b in the others.
  ALHAZEN_INLINE friend Lanes choose(uint32_t lanes, const Lanes& a, const Lanes& b) {
    return map([&](int i) { return chosen(lanes >> (i * per_register), a.r[i], b.r[i]); });
  }

  /// a * b + c, rounded once if the processor can: for bounds, which need not be the same everywhere.
  ALHAZEN_INLINE friend Lanes fused_multiply_add(const Lanes& a, const Lanes& b, const Lanes& c) {
    return map([&](int i) { return fused(a.r[i], b.r[i], c.r[i]); });
  }

  ALHAZEN_INLINE friend Lanes square_root(const Lanes& a) {
    return map([&](int i) { return root(a.r[i]); });
  }

  /// A bit for each lane, set where a <= b.
  ALHAZEN_INLINE friend uint32_t less_equal(const Lanes& a, const Lanes& b) {
    uint32_t bits = 0;
    for (int i = 0; i < registers; ++i) bits |= less_equal_bits(a.r[i], b.r[i]) << (i * per_register);
    return bits;
  }

  /// A bit for each lane, set where a < b.
  ALHAZEN_INLINE friend uint32_t less(const Lanes& a, const Lanes& b) {
    uint32_t bits = 0;
    for (int i = 0; i < registers; ++i) bits |= less_bits(a.r[i], b.r[i]) << (i * per_register);
    return bits;
  }

  /// A bit for each lane, set where a == b.
  ALHAZEN_INLINE friend uint32_t equal(const Lanes& a, const Lanes& b) {
    uint32_t bits = 0;
    for (int i = 0; i < registers; ++i) bits |= equal_bits(a.r[i], b.r[i]) << (i * per_register);
    return bits;
  }

 private:
  static constexpr bool is_float = sizeof(T) == sizeof(float);

  // Operators that compilers do not translate well by themselves; `if constexpr` selects one instruction here.

  ALHAZEN_INLINE static Register fused(const Register& a, const Register& b, const Register& c) {
#if defined(__AVX512F__)
    if constexpr (register_bytes == 64 && is_float) return (Register)_mm512_fmadd_ps((__m512)a, (__m512)b, (__m512)c);
    if constexpr (register_bytes == 64 && !is_float)
      return (Register)_mm512_fmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
#endif
#if defined(__FMA__)
    if constexpr (register_bytes == 32 && is_float) return (Register)_mm256_fmadd_ps((__m256)a, (__m256)b, (__m256)c);
    if constexpr (register_bytes == 32 && !is_float)
      return (Register)_mm256_fmadd_pd((__m256d)a, (__m256d)b, (__m256d)c);
    if constexpr (register_bytes == 16 && is_float) return (Register)_mm_fmadd_ps((__m128)a, (__m128)b, (__m128)c);
    if constexpr (register_bytes == 16 && !is_float) return (Register)_mm_fmadd_pd((__m128d)a, (__m128d)b, (__m128d)c);
#endif
    return a * b + c;
  }

  ALHAZEN_INLINE static Register root(const Register& a) {
#if defined(__AVX512F__)  // masked, since GCC 12 warns of an uninitialized variable in the plain ones
    if constexpr (register_bytes == 64 && is_float) return (Register)_mm512_maskz_sqrt_ps(0xffff, (__m512)a);
    if constexpr (register_bytes == 64 && !is_float) return (Register)_mm512_maskz_sqrt_pd(0xff, (__m512d)a);
#endif
#if defined(__AVX__)
    if constexpr (register_bytes == 32 && is_float) return (Register)_mm256_sqrt_ps((__m256)a);
    if constexpr (register_bytes == 32 && !is_float) return (Register)_mm256_sqrt_pd((__m256d)a);
#endif
#if defined(__SSE2__)
    if constexpr (register_bytes == 16 && is_float) return (Register)_mm_sqrt_ps((__m128)a);
    if constexpr (register_bytes == 16 && !is_float) return (Register)_mm_sqrt_pd((__m128d)a);
#endif
    Register v;
    for (int k = 0; k < per_register; ++k) v[k] = std::sqrt(a[k]);
    return v;
  }

  ALHAZEN_INLINE static Register chosen(uint32_t lanes, const Register& a, const Register& b) {
#if defined(__AVX512F__)
    if constexpr (register_bytes == 64 && is_float)
      return (Register)_mm512_mask_blend_ps(static_cast<__mmask16>(lanes), (__m512)b, (__m512)a);
    if constexpr (register_bytes == 64 && !is_float)
      return (Register)_mm512_mask_blend_pd(static_cast<__mmask8>(lanes), (__m512d)b, (__m512d)a);
#endif
    Integers bit;
    for (int k = 0; k < per_register; ++k) bit[k] = Integer{1} << k;
    return (static_cast<Integer>(lanes) & bit) != 0 ? a : b;
  }

  ALHAZEN_INLINE static uint32_t less_equal_bits(const Register& a, const Register& b) {
#if defined(__AVX512F__)
    if constexpr (register_bytes == 64 && is_float) return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_LE_OQ);
    if constexpr (register_bytes == 64 && !is_float) return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_LE_OQ);
#endif
    return bits_of(a <= b);
  }

  ALHAZEN_INLINE static uint32_t less_bits(const Register& a, const Register& b) {
#if defined(__AVX512F__)
    if constexpr (register_bytes == 64 && is_float) return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_LT_OQ);
    if constexpr (register_bytes == 64 && !is_float) return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_LT_OQ);
#endif
    return bits_of(a < b);
  }

  ALHAZEN_INLINE static uint32_t equal_bits(const Register& a, const Register& b) {
#if defined(__AVX512F__)
    if constexpr (register_bytes == 64 && is_float) return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_EQ_OQ);
    if constexpr (register_bytes == 64 && !is_float) return _mm512_cmp_pd_mask((__m512d)a, (__m512d)b, _CMP_EQ_OQ);
#endif
    return bits_of(a == b);
  }

  template <class Comparison>
  ALHAZEN_INLINE static uint32_t bits_of(Comparison c) {
#if defined(__AVX__)
    if constexpr (register_bytes == 32 && sizeof(T) == 4) return static_cast<uint32_t>(_mm256_movemask_ps((__m256)c));
    if constexpr (register_bytes == 32 && sizeof(T) == 8) return static_cast<uint32_t>(_mm256_movemask_pd((__m256d)c));
#endif
#if defined(__SSE2__)
    if constexpr (register_bytes == 16 && sizeof(T) == 4) return static_cast<uint32_t>(_mm_movemask_ps((__m128)c));
    if constexpr (register_bytes == 16 && sizeof(T) == 8) return static_cast<uint32_t>(_mm_movemask_pd((__m128d)c));
#endif
    uint32_t bits = 0;
    for (int k = 0; k < per_register; ++k) bits |= static_cast<uint32_t>(c[k] & 1) << k;
    return bits;
  }
};

}  // namespace ALHAZEN_CORE

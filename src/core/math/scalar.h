#pragma once

// Constants, rounding bounds and the few scalar functions that the rest of the core is built on.

#include <cmath>
#include <cstdint>
#include <limits>

#include "core/math/platform.h"

namespace ALHAZEN_CORE {

template <class Real>
inline constexpr Real pi = Real(3.14159265358979323846264338327950288);
template <class Real>
inline constexpr Real inv_pi = Real(0.318309886183790671537767526745028724);
template <class Real>
inline constexpr Real infinity = std::numeric_limits<Real>::infinity();
/// The largest number below 1.
template <class Real>
inline constexpr Real one_minus_epsilon = Real(1) - std::numeric_limits<Real>::epsilon() / 2;

/// Bound on the relative error of a chain of `n` rounded operations (Higham 2002, section 3.1).
template <class Real>
ALHAZEN_HD constexpr Real rounding_bound(int n) {
  const Real unit = std::numeric_limits<Real>::epsilon() / 2;
  return (static_cast<Real>(n) * unit) / (Real(1) - static_cast<Real>(n) * unit);
}

template <class Real>
ALHAZEN_HD constexpr Real sqr(Real x) {
  return x * x;
}

template <class Real>
ALHAZEN_HD constexpr Real clamp(Real x, Real low, Real high) {
  return x < low ? low : x > high ? high : x;
}

/// Square root of a number that is negative only by rounding.
template <class Real>
ALHAZEN_HD inline Real safe_sqrt(Real x) {
  return std::sqrt(x > 0 ? x : Real(0));
}

template <class Real>
ALHAZEN_HD constexpr Real smaller(Real a, Real b) {
  return a < b ? a : b;
}

template <class Real>
ALHAZEN_HD constexpr Real larger(Real a, Real b) {
  return a > b ? a : b;
}

template <class Real>
struct SineCosine {
  Real sine, cosine;
};

/// In float, to 1e-7, by operations that round alike everywhere, for angles up to 8192: reduced to an eighth of
/// a turn by pi / 2 in three parts (Cody and Waite 1980), then the polynomials of Moshier's Cephes library.
ALHAZEN_HD inline SineCosine<float> sine_cosine_by_polynomials(float angle) {
  const float quarters = angle * 0.636619772f;
  const int quarter = static_cast<int>(quarters + (quarters < 0 ? -0.5f : 0.5f));
  const float q = static_cast<float>(quarter);
  const float x = ((angle - q * 1.5703125f) - q * 4.8375129e-4f) - q * 7.5497899e-8f;
  const float x2 = x * x;
  const float sine = x + x * x2 * (-1.6666654611e-1f + x2 * (8.3321608736e-3f + x2 * -1.9515295891e-4f));
  const float cosine =
      1 - 0.5f * x2 + x2 * x2 * (4.166664568298827e-2f + x2 * (-1.388731625493765e-3f + x2 * 2.443315711809948e-5f));
  const bool swaps = quarter & 1;
  const float s = swaps ? cosine : sine, c = swaps ? sine : cosine;
  return {quarter & 2 ? -s : s, (quarter + 1) & 2 ? -c : c};
}

/// Of an angle in radians. In float a GPU takes them of angle / pi, which needs neither tables nor double for its
/// range.
template <class Real>
ALHAZEN_HD inline SineCosine<Real> sine_cosine(Real angle) {
  if constexpr (sizeof(Real) == sizeof(float)) {
#if defined(__CUDA_ARCH__)
    SineCosine<Real> both;
    sincospif(angle * inv_pi<float>, &both.sine, &both.cosine);
    return both;
#else
    if (std::abs(angle) < 8192) return sine_cosine_by_polynomials(angle);
#endif
  }
  return {std::sin(angle), std::cos(angle)};
}

/// a * b + c, with one rounding on GPUs, with two on CPUs, where the same bits are to come of every instruction set.
template <class Real>
ALHAZEN_HD inline Real multiply_add(Real a, Real b, Real c) {
#if defined(__CUDA_ARCH__)
  return std::fma(a, b, c);
#else
  return a * b + c;
#endif
}

/// a * b - c * d. With fused operations the error is below 1.5 ulp and the sign is always right (Kahan; Jeannerod,
/// Louvet and Muller 2013). Without them, on CPUs, it is still exactly antisymmetric under exchange of the two
/// products.
template <class Real>
ALHAZEN_HD inline Real difference_of_products(Real a, Real b, Real c, Real d) {
#if defined(__CUDA_ARCH__)
  const Real cd = c * d;
  return std::fma(a, b, -cd) + std::fma(-c, d, cd);
#else
  return a * b - c * d;
#endif
}

/// The neighbouring number away from `x` in the direction of the sign of `towards`.
template <class Real>
ALHAZEN_HD inline Real next_towards(Real x, Real towards) {
  const Real step = std::abs(x) * std::numeric_limits<Real>::epsilon() + std::numeric_limits<Real>::min();
  return towards > 0 ? x + step : towards < 0 ? x - step : x;
}

}  // namespace ALHAZEN_CORE

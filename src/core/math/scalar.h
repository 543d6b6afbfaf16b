#pragma once

// Constants, rounding bounds and scalar functions.

#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

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

/// Square root of a number that may be negative by rounding only.
template <class Real>
ALHAZEN_HD inline Real safe_sqrt(Real x) {
  return std::sqrt(x > 0 ? x : Real(0));
}

template <class Real>
ALHAZEN_HD constexpr Real min(Real a, Real b) {
  return a < b ? a : b;
}

template <class Real>
ALHAZEN_HD constexpr Real max(Real a, Real b) {
  return a > b ? a : b;
}

template <class Number>
requires std::is_arithmetic_v<Number> ALHAZEN_HD constexpr Number select(bool first, Number a, Number b) {
  return first ? a : b;
}

template <class Real>
ALHAZEN_HD ALHAZEN_HOT constexpr Real lerp(Real a, Real b, Real t) {
  return a * (1 - t) + b * t;
}

template <class Real>
struct SineCosine {
  Real sine, cosine;
};

/// Sine and cosine in float, to 1e-7, by operations that round alike everywhere, for angles up to 8192: range reduction
/// by pi / 2 in three parts (Cody and Waite 1980), then the polynomials of Moshier's Cephes library.
ALHAZEN_HD ALHAZEN_HOT SineCosine<float> sine_cosine_by_polynomials(float angle) {
  // Rounds to the nearest integer: floats beyond 2^23 are integers.
  const float q = (angle * 0.636619772f + 12582912.0f) - 12582912.0f;
  const int quarter = static_cast<int>(q);
  const float x = ((angle - q * 1.5703125f) - q * 4.8375129e-4f) - q * 7.5497899e-8f;
  const float x2 = x * x;
  const float sine = x + x * x2 * (-1.6666654611e-1f + x2 * (8.3321608736e-3f + x2 * -1.9515295891e-4f));
  const float cosine =
      1 - 0.5f * x2 + x2 * x2 * (4.166664568298827e-2f + x2 * (-1.388731625493765e-3f + x2 * 2.443315711809948e-5f));
  const bool swaps = quarter & 1;
  const float s = swaps ? cosine : sine, c = swaps ? sine : cosine;
  return {quarter & 2 ? -s : s, (quarter + 1) & 2 ? -c : c};
}

/// The same in double, to 3e-16.
ALHAZEN_HD ALHAZEN_HOT SineCosine<double> sine_cosine_by_polynomials(double angle) {
  const double q = (angle * 0.63661977236758134308 + 6755399441055744.0) - 6755399441055744.0;
  const int quarter = static_cast<int>(q);
  const double x =
      ((angle - q * 1.57079625129699707031) - q * 7.54978941586159635335e-8) - q * 5.39030285815811905290e-15;
  const double x2 = x * x;
  const double sine = x + x * x2 *
                              (-1.66666666666666307295e-1 +
                               x2 * (8.33333333332211858878e-3 +
                                     x2 * (-1.98412698295895385996e-4 +
                                           x2 * (2.75573136213857245213e-6 + x2 * (-2.50507477628578072866e-8 +
                                                                                   x2 * 1.58962301576546568060e-10)))));
  const double cosine = 1 - 0.5 * x2 +
                        x2 * x2 *
                            (4.16666666666665929218e-2 +
                             x2 * (-1.38888888888730564116e-3 +
                                   x2 * (2.48015872888517045348e-5 +
                                         x2 * (-2.75573141792967388112e-7 +
                                               x2 * (2.08757008419747316778e-9 + x2 * -1.13585365213876817300e-11)))));
  const bool swaps = quarter & 1;
  const double s = swaps ? cosine : sine, c = swaps ? sine : cosine;
  return {quarter & 2 ? -s : s, (quarter + 1) & 2 ? -c : c};
}

/// Sine and cosine of an angle in radians, a few turns at most. In float a GPU computes them of angle / pi, which needs
/// neither tables nor double for range reduction.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT SineCosine<Real> sine_cosine_of_turn(Real angle) {
#if defined(__CUDA_ARCH__)
  if constexpr (sizeof(Real) == sizeof(float)) {
    SineCosine<Real> both;
    sincospif(angle * inv_pi<float>, &both.sine, &both.cosine);
    return both;
  }
#endif
  return sine_cosine_by_polynomials(angle);
}

/// Sine and cosine of any angle in radians.
template <class Real>
ALHAZEN_HD inline SineCosine<Real> sine_cosine(Real angle) {
#if defined(__CUDA_ARCH__)
  if constexpr (sizeof(Real) == sizeof(float)) return sine_cosine_of_turn(angle);
#endif
  if (std::abs(angle) < 8192) return sine_cosine_of_turn(angle);
  return {std::sin(angle), std::cos(angle)};
}

/// The arctangent of t, |t| <= tan(pi / 8), in float, to 1e-7: the polynomial of Moshier's Cephes library.
ALHAZEN_HD ALHAZEN_HOT float arctangent_by_polynomials(float t) {
  const float t2 = t * t;
  return t +
         t * t2 * (-3.33329491539e-1f + t2 * (1.99777106478e-1f + t2 * (-1.38776856032e-1f + t2 * 8.05374449538e-2f)));
}

/// The same in double, to 3e-16.
ALHAZEN_HD ALHAZEN_HOT double arctangent_by_polynomials(double t) {
  const double t2 = t * t;
  const double p =
      -6.485021904942025371773e1 +
      t2 * (-1.228866684490136173410e2 +
            t2 * (-7.500855792314704667340e1 + t2 * (-1.615753718733365076637e1 + t2 * -8.750608600031904122785e-1)));
  const double q =
      1.945506571482613964425e2 +
      t2 *
          (4.853903996359136964868e2 +
           t2 * (4.328810604912902668951e2 + t2 * (1.650270098316988542046e2 + t2 * (2.485846490142306297962e1 + t2))));
  return t + t * t2 * (p / q);
}

/// The angle in [0, pi] between the vector (x, y), y >= 0, and the x axis, by operations that round alike everywhere.
/// Reduces the angle to a sixteenth of a turn.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Real angle_of_vector(Real x, Real y) {
  const Real ax = std::abs(x);
  const bool steep = y > ax;
  const Real less = steep ? ax : y, more = steep ? y : ax;
  const bool upper = less > Real(0.41421356237309503) * more;
  const Real t = upper ? (less - more) / (less + more) : more > 0 ? less / more : Real(0);
  const Real angle = arctangent_by_polynomials(t);
  const Real octant = upper ? angle + pi<Real> / 4 : angle;
  const Real quarter = steep ? pi<Real> / 2 - octant : octant;
  return x < 0 ? pi<Real> - quarter : quarter;
}

/// a * b + c, rounded once on GPUs and twice on CPUs, where all instruction sets must give the same bits.
template <class Real>
ALHAZEN_HD inline Real multiply_add(Real a, Real b, Real c) {
#if defined(__CUDA_ARCH__)
  return std::fma(a, b, c);
#else
  return a * b + c;
#endif
}

/// a * b - c * d. With fused operations the error is below 1.5 ulp and the sign is always right (Kahan; Jeannerod,
/// Louvet and Muller 2013). Without them, on CPUs, it is still exactly antisymmetric when the products are exchanged.
template <class Real>
ALHAZEN_HD inline Real difference_of_products(Real a, Real b, Real c, Real d) {
#if defined(__CUDA_ARCH__)
  const Real cd = c * d;
  return std::fma(a, b, -cd) + std::fma(-c, d, cd);
#else
  return a * b - c * d;
#endif
}

/// The next representable number after `x` in the direction of the sign of `towards`.
template <class Real>
ALHAZEN_HD inline Real next_towards(Real x, Real towards) {
  const Real step = std::abs(x) * std::numeric_limits<Real>::epsilon() + std::numeric_limits<Real>::min();
  return towards > 0 ? x + step : towards < 0 ? x - step : x;
}

}  // namespace ALHAZEN_CORE

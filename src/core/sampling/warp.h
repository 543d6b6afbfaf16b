#pragma once

// Maps the unit square to the domains that are sampled, with the density of each mapping.

#include "core/math/scalar.h"
#include "core/math/vec.h"

namespace ALHAZEN_CORE {

/// Uniform over the unit disk by radius and angle.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec2<Real> sample_disk_polar(const Vec2<Real>& u) {
  const Real r = std::sqrt(u.x), phi = 2 * pi<Real> * u.y;
  const auto [sine, cosine] = sine_cosine_of_turn(phi);
  return {r * cosine, r * sine};
}

/// Uniform over the unit disk; neighbouring points stay neighbours (Shirley and Chiu 1997).
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec2<Real> sample_disk(const Vec2<Real>& u) {
  const Real x = 2 * u.x - 1, y = 2 * u.y - 1;
  if (x == 0 && y == 0) return {};
  const bool by_x = std::abs(x) > std::abs(y);
  const Real r = by_x ? x : y;
  const Real phi = by_x ? pi<Real> / 4 * (y / x) : pi<Real> / 2 - pi<Real> / 4 * (x / y);
  const auto [sine, cosine] = sine_cosine_of_turn(phi);
  return {r * cosine, r * sine};
}

/// Hemisphere about +z with density cos / pi over solid angle (Malley's method).
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec3<Real> sample_cosine_hemisphere(const Vec2<Real>& u) {
  const Vec2<Real> d = sample_disk(u);
  return {d.x, d.y, safe_sqrt(1 - d.x * d.x - d.y * d.y)};
}

template <class Real>
ALHAZEN_HD constexpr Real pdf_cosine_hemisphere(Real cos_theta) {
  return cos_theta > 0 ? cos_theta * inv_pi<Real> : Real(0);
}

/// The whole sphere with density 1 / (4 pi) over solid angle.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec3<Real> sample_uniform_sphere(const Vec2<Real>& u) {
  const Real z = 1 - 2 * u.x, r = safe_sqrt(1 - z * z), phi = 2 * pi<Real> * u.y;
  const auto [sine, cosine] = sine_cosine_of_turn(phi);
  return {r * cosine, r * sine, z};
}

template <class Real>
inline constexpr Real pdf_uniform_sphere = inv_pi<Real> / 4;

/// MIS weight of a strategy with density `a` against one with density `b` (power heuristic, exponent 2; Veach 1997,
/// 9.2.4). It is computed from the ratio, so that neither square can overflow.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Real power_heuristic(Real a, Real b) {
  if (!(a > 0)) return 0;
  if (!(a < infinity<Real>)) return 1;
  const Real ratio = b / a;
  return 1 / (1 + ratio * ratio);
}

}  // namespace ALHAZEN_CORE

#pragma once

// Sheen of cloth: the distribution of Estevez and Kulla 2017 ("Production Friendly Microfacet Sheen BRDF") with the
// visibility of Neubelt and Pettineo 2013, as KHR_materials_sheen has them.

#include "core/math/scalar.h"
#include "core/math/vec.h"

namespace ALHAZEN_CORE {

/// Evaluates f * cos of `i` for colour 1; `o.z` and `i.z` are > 0.
template <class Real>
ALHAZEN_HD Real evaluate_sheen(Real roughness, const Vec3<Real>& o, const Vec3<Real>& i) {
  const Vec3<Real> half = o + i;
  if (is_zero(half)) return 0;
  const Vec3<Real> m = normalize(half);
  const Real inverse_alpha = 1 / max(roughness * roughness, Real(0.005));
  const Real sine = safe_sqrt(1 - m.z * m.z);
  const Real d = (2 + inverse_alpha) * std::pow(sine, inverse_alpha) * Real(0.5) * inv_pi<Real>;
  return d * i.z / (4 * (o.z + i.z - o.z * i.z));
}

/// Sheen is bright along the horizon, in a band as wide as the roughness: 1 - cos has the density k (1 - cos)^(k - 1).
template <class Real>
ALHAZEN_HD Real sheen_exponent(Real roughness) {
  return max(Real(1), Real(0.65) / roughness);
}

/// Samples a direction for sheen, the same for all outgoing directions.
template <class Real>
ALHAZEN_HD Vec3<Real> sample_sheen(Real roughness, const Vec2<Real>& u) {
  const Real z = 1 - std::pow(u.x, 1 / sheen_exponent(roughness)), r = safe_sqrt(1 - z * z);
  const auto [sine, cosine] = sine_cosine_of_turn(2 * pi<Real> * u.y);
  return {r * cosine, r * sine, z};
}

/// Returns the density of sample_sheen with respect to solid angle.
template <class Real>
ALHAZEN_HD Real pdf_sheen(Real roughness, Real cosine) {
  const Real k = sheen_exponent(roughness);
  return k * std::pow(max(Real(0), 1 - cosine), k - 1) * Real(0.5) * inv_pi<Real>;
}

}  // namespace ALHAZEN_CORE

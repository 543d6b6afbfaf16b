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

}  // namespace ALHAZEN_CORE

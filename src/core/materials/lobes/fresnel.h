#pragma once

// Fresnel reflectance of interfaces for unpolarised light.

#include "core/math/scalar.h"
#include "core/math/vec.h"

namespace ALHAZEN_CORE {

/// Returns the Fresnel reflectance of a dielectric interface for the cosines of incidence and refraction, both >= 0 and
/// not both 0.
template <class Real>
ALHAZEN_HD constexpr Real fresnel_of_cosines(Real cos_i, Real cos_t, Real eta) {
  const Real parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  const Real perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
  return Real(0.5) * (parallel * parallel + perpendicular * perpendicular);
}

/// Returns the Fresnel reflectance of a dielectric interface. `cos_i` >= 0 is the cosine of incidence, `eta` the index
/// of the other side relative to this one. `cos_t` receives the cosine of refraction, 0 on total internal reflection.
template <class Real>
ALHAZEN_HD Real fresnel_dielectric(Real cos_i, Real eta, Real& cos_t) {
  const Real sin2_t = (1 - cos_i * cos_i) / (eta * eta);
  if (sin2_t >= 1) {
    cos_t = 0;
    return 1;
  }
  cos_t = safe_sqrt(1 - sin2_t);
  return fresnel_of_cosines(cos_i, cos_t, eta);
}

/// Returns the Fresnel reflectance of a conductor with index `eta` and absorption coefficient `k` relative to the
/// outside (PBR 4th ed., 9.3.6, in real arithmetic).
template <class Real>
ALHAZEN_HD Real fresnel_conductor(Real cos_i, Real eta, Real k) {
  const Real cos2 = cos_i * cos_i, sin2 = 1 - cos2;
  const Real eta2 = eta * eta, k2 = k * k;
  const Real t0 = eta2 - k2 - sin2;
  const Real a2_plus_b2 = safe_sqrt(t0 * t0 + 4 * eta2 * k2);
  const Real t1 = a2_plus_b2 + cos2;
  const Real a = safe_sqrt(Real(0.5) * (a2_plus_b2 + t0));
  const Real t2 = 2 * a * cos_i;
  if (!(t1 + t2 > 0)) return 1;  // grazing incidence on an interface without change of index
  const Real perpendicular = (t1 - t2) / (t1 + t2);
  const Real t3 = cos2 * a2_plus_b2 + sin2 * sin2;
  const Real t4 = t2 * sin2;
  const Real parallel = t3 + t4 > 0 ? perpendicular * (t3 - t4) / (t3 + t4) : perpendicular;
  return Real(0.5) * (parallel + perpendicular);
}

template <class Real>
ALHAZEN_HD Vec3<Real> fresnel_conductor(Real cos_i, const Vec3<Real>& eta, const Vec3<Real>& k) {
  return {fresnel_conductor(cos_i, eta.x, k.x), fresnel_conductor(cos_i, eta.y, k.y),
          fresnel_conductor(cos_i, eta.z, k.z)};
}

/// Returns the absorption coefficient that, with an index of 1, gives `reflectance` at normal incidence.
template <class Real>
ALHAZEN_HD Real absorption_for_reflectance(Real reflectance) {
  const Real r = clamp(reflectance, Real(0), Real(0.9999));
  return 2 * std::sqrt(r) / std::sqrt(1 - r);
}

template <class Real>
ALHAZEN_HD Vec3<Real> absorption_for_reflectance(const Vec3<Real>& reflectance) {
  return {absorption_for_reflectance(reflectance.x), absorption_for_reflectance(reflectance.y),
          absorption_for_reflectance(reflectance.z)};
}

/// Returns (1 - cos)^5, the weight of Schlick's approximation (1994).
template <class Real>
ALHAZEN_HD Real schlick_weight(Real cosine) {
  const Real x = clamp(1 - cosine, Real(0), Real(1));
  return x * x * x * x * x;
}

}  // namespace ALHAZEN_CORE

#pragma once

// Interference in a film as thin as a few wavelengths of light (Belcour and Barla 2017, "A Practical Extension to
// Microfacet Theory for the Modeling of Varying Iridescence"), as KHR_materials_iridescence has it.

#include "core/materials/lobes/fresnel.h"

namespace ALHAZEN_CORE {

/// Returns the sensitivity to an optical path difference in metres with a phase `shift`, in linear sRGB: the transform
/// of Gaussians fitted to the colour matching functions (constants of the paper's supplement).
template <class Real>
ALHAZEN_HD Vec3<Real> film_sensitivity(Real path_difference, const Vec3<Real>& shift) {
  const Real phase = 2 * pi<Real> * path_difference * Real(1e6);  // per micrometre
  const auto band = [&](Real value, Real position, Real variance, Real offset) {
    return value * std::sqrt(2 * pi<Real> * variance) * sine_cosine(position * phase + offset).cosine *
           std::exp(-variance * phase * phase);
  };
  const Real x = band(Real(5.4856e-13 * 1e6), Real(1.6810), Real(4.3278e-3), shift.x) +
                 Real(9.7470e-14 * 1e6) * std::sqrt(2 * pi<Real> * Real(4.5282e-3)) *
                     sine_cosine(Real(2.2399) * phase + shift.x).cosine * std::exp(-Real(4.5282e-3) * phase * phase);
  const Real y = band(Real(4.4201e-13 * 1e6), Real(1.7953), Real(9.3046e-3), shift.y);
  const Real z = band(Real(5.2481e-13 * 1e6), Real(2.2084), Real(6.6121e-3), shift.z);
  const Real scale = Real(1 / (1.0685e-7));
  const Vec3<Real> xyz = Vec3<Real>{x, y, z} * scale;
  // By columns: GCC contracts the form by rows into fused instructions, even with -ffp-contract=off.
  return Vec3<Real>{Real(3.2404542), Real(-0.9692660), Real(0.0556434)} * xyz.x +
         Vec3<Real>{Real(-1.5371385), Real(1.8760108), Real(-0.2040259)} * xyz.y +
         Vec3<Real>{Real(-0.4985314), Real(0.0415560), Real(1.0572252)} * xyz.z;
}

/// Returns the reflectance of a film of `thickness` nanometres over a base whose reflectance at normal incidence is
/// `f0`. `cosine` is measured outside the film.
template <class Real>
ALHAZEN_HD Vec3<Real> film_reflectance(Real cosine, Real film_ior, Real thickness, const Vec3<Real>& f0) {
  const Real ramp = clamp(thickness / Real(0.03), Real(0), Real(1));
  const Real eta = 1 + (film_ior - 1) * ramp * ramp * (3 - 2 * ramp);  // fades out as the thickness approaches 0
  const Real sin2 = (1 - cosine * cosine) / (eta * eta);
  if (sin2 >= 1) return splat(Real(1));
  const Real cos_within = std::sqrt(1 - sin2);
  const Real x = 1 - cosine, r0 = sqr((eta - 1) / (eta + 1));
  const Real r12 = r0 + (1 - r0) * x * x * x * x * x, t121 = 1 - r12;
  const Real phi21 = eta < 1 ? Real(0) : pi<Real>;
  const Real x2 = 1 - cos_within, edge = x2 * x2 * x2 * x2 * x2;
  Vec3<Real> r23{}, phase{}, sum{};
  for (int c = 0; c < 3; ++c) {
    const Real root = std::sqrt(clamp(f0[c], Real(0), Real(0.9999)));
    const Real base_ior = (1 + root) / (1 - root);
    const Real base_r0 = sqr((base_ior - eta) / (base_ior + eta));
    r23[c] = base_r0 + (1 - base_r0) * edge;
    phase[c] = phi21 + (base_ior < eta ? pi<Real> : Real(0));
  }
  const Real path = 2 * eta * thickness * cos_within * Real(1e-9);
  Vec3<Real> term{};
  for (int c = 0; c < 3; ++c) {
    const Real r123 = clamp(r12 * r23[c], Real(1e-5), Real(0.9999));
    const Real s = t121 * t121 * r23[c] / (1 - r123);
    sum[c] = r12 + s;
    term[c] = s - t121;
  }
  for (int m = 1; m <= 2; ++m) {
    for (int c = 0; c < 3; ++c) term[c] *= std::sqrt(clamp(r12 * r23[c], Real(1e-5), Real(0.9999)));
    const Real order = static_cast<Real>(m);
    sum += term * film_sensitivity(order * path, phase * order) * Real(2);
  }
  return max(min(sum, splat(Real(1))), Vec3<Real>{});
}

/// Returns the f0 for which Schlick's approximation at `cosine` is `reflectance`.
template <class Real>
ALHAZEN_HD Vec3<Real> f0_of_reflectance(const Vec3<Real>& reflectance, Real cosine) {
  const Real x = clamp(1 - cosine, Real(0), Real(1));
  const Real edge = clamp(x * x * x * x * x, Real(0), Real(0.9999));
  return max((reflectance - splat(edge)) / (1 - edge), Vec3<Real>{});
}

}  // namespace ALHAZEN_CORE

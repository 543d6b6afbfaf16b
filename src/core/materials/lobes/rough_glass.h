#pragma once

// Rough glass that conserves energy, as in core/materials/dielectric.h, with colours. A coating may change the
// reflectance of the microfacets; they transmit the rest, and all is scaled to conserve energy, which is then not
// reciprocal.

#include "core/materials/dielectric.h"

namespace ALHAZEN_CORE {

template <class Real>
struct GlassBsdf {
  DielectricBsdf<Real, Vec2<Real>> interface;
  Vec3<Real> constant, by_fresnel;  ///< reflectance of microfacets: constant + by_fresnel * F
  Vec3<Real> tint;                  ///< factor on reflection outside; the rest of it is absorbed
  Vec3<Real> through;               ///< factor on transmission
};

/// Returns the reflectance of a microfacet. `total`: total internal reflection.
template <class Real>
ALHAZEN_HD Vec3<Real> glass_reflectance(const GlassBsdf<Real>& glass, Real fresnel, bool total) {
  if (total) return splat(Real(1));
  return max(min(glass.constant + glass.by_fresnel * fresnel, splat(Real(1))), Vec3<Real>{});
}

/// Returns the probability of sampling reflection at a microfacet.
template <class Real>
ALHAZEN_HD Real glass_reflection_rate(const Vec3<Real>& reflectance) {
  return min(Real(1), (reflectance.x + reflectance.y + reflectance.z) * (Real(1) / 3));
}

/// Returns the factor that makes the directional albedo for the direction `o` equal to 1 if the reflectance of the
/// microfacets is not that of bare glass.
template <class Real>
ALHAZEN_HD Vec3<Real> glass_normalization(const GlassBsdf<Real>& glass, const GlassGridDirection<Real>& o) {
  const AlbedoGridPlace<Real>& grid = glass.interface.grid;
  const Vec3<Real> albedo =
      splat(Real(1)) + glass.constant * grid_albedo(grid, o.first + GlassGrid::by_constant, o.direction) +
      (glass.by_fresnel - splat(Real(1))) * grid_albedo(grid, o.first + GlassGrid::by_fresnel, o.direction);
  return splat(Real(1)) / max(albedo, splat(Real(0.01)));
}

/// Evaluates single scattering without compensation and without colours.
template <class Real>
ALHAZEN_HD BsdfValue<Real> evaluate_single_scattering(const GlassBsdf<Real>& glass, const Vec3<Real>& wo,
                                                      const Vec3<Real>& wi) {
  DielectricFacet<Real> f;
  if (!dielectric_facet(glass.interface, wo, wi, f)) return {};
  const Vec3<Real> reflectance = glass_reflectance(glass, f.rate, f.total);
  const Real rate = glass_reflection_rate(reflectance);
  if (f.reflects) return {reflectance * (f.d * f.g2 / (4 * f.cos_n)), rate * f.density / (4 * f.cos_o)};
  const Real jacobian = -f.cos_i / sqr(f.cos_i + f.cos_o / f.eta);
  return {(splat(Real(1)) - reflectance) * (f.d * f.g2 * jacobian * f.cos_o / (f.cos_n * f.eta * f.eta)),
          (1 - rate) * f.density * jacobian};
}

template <class Real>
ALHAZEN_HD BsdfValue<Real> evaluate_glass(const GlassBsdf<Real>& glass, const Vec3<Real>& wo, const Vec3<Real>& wi) {
  if (wo.z == 0 || wi.z == 0) return {};
  const DielectricBsdf<Real, Vec2<Real>>& interface = glass.interface;
  const GlassGridDirection<Real> o = glass_direction(interface.grid, interface.ior, wo);
  BsdfValue<Real> v = evaluate_single_scattering(glass, wo, wi);
  compensate(interface, wo, glass_albedo(interface.grid, o), wi, v);
  v.value *= glass_normalization(glass, o);
  if (wo.z * wi.z < 0)
    v.value *= glass.through;
  else if (wo.z > 0)
    v.value *= glass.tint;
  return v;
}

/// Samples a direction; returns zero if there is none. evaluate_glass gives its value and density.
template <class Real>
ALHAZEN_HD Vec3<Real> sample_glass(const GlassBsdf<Real>& glass, const Vec3<Real>& wo, Real u_lobe,
                                   const Vec2<Real>& u) {
  const DielectricBsdf<Real, Vec2<Real>>& interface = glass.interface;
  const Real missing = glass_albedo(interface.grid, interface.ior, wo).missing, single = 1 - missing;
  if (!(u_lobe < single))
    return sample_glass_lobe(glass_lobe(interface.grid, interface.ior, wo.z < 0), wo, (u_lobe - single) / missing, u);
  const DielectricBranches<Real> branches = dielectric_branches(interface, wo, u);
  const bool total = !(branches.reflected_rate < 1);
  const Real rate = glass_reflection_rate(glass_reflectance(glass, branches.reflected_rate, total));
  return u_lobe < rate * single ? branches.reflected.direction : branches.refracted.direction;
}

/// Changes the reflectance of the microfacets so that, where the Fresnel reflectance of bare glass is `smooth`, it is
/// blended by `amount` with `wanted`, the reflectance with a film: scales the transmittance if it grows, or else the
/// reflectance. `wanted` already includes the tint, so that the part due to the film is not tinted again.
template <class Real>
ALHAZEN_HD void add_film_to_glass(GlassBsdf<Real>& glass, Real smooth, const Vec3<Real>& wanted, Real amount) {
  for (int c = 0; c < 3; ++c) {
    const Real bare = glass.by_fresnel[c] * smooth, with = bare + (wanted[c] - bare) * amount;
    if (with > 0) glass.tint[c] = 1 - (1 - glass.tint[c]) * min(Real(1), bare * (1 - amount) / with);
    if (with >= bare) {
      const Real let_in = (1 - with) / max(1 - bare, Real(1e-6));
      glass.constant[c] = 1 - let_in;
      glass.by_fresnel[c] *= let_in;
    } else {
      glass.by_fresnel[c] *= with / bare;
    }
  }
}

}  // namespace ALHAZEN_CORE

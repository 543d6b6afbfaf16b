#pragma once

// Rough glass that conserves energy, as in core/materials/dielectric.h, with colours. A coating may change the
// reflectance of the microfacets; they transmit the rest, and what is missing is changed to conserve energy, which is
// then not reciprocal.

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

/// Returns the fraction of light from `wo` that single scattering loses.
template <class Real>
ALHAZEN_HD Vec3<Real> glass_missing(const GlassBsdf<Real>& glass, const Vec3<Real>& wo) {
  const AlbedoGridPlace<Real>& grid = glass.interface.grid;
  const GlassGridDirection<Real> o = glass_direction(grid, glass.interface.ior, wo);
  const Vec3<Real> missing =
      splat(glass_missing(grid, o)) -
      glass.constant * grid_albedo(grid, o.first + GlassGrid::by_constant, o.direction) -
      (glass.by_fresnel - splat(Real(1))) * grid_albedo(grid, o.first + GlassGrid::by_fresnel, o.direction);
  return max(min(missing, splat(Real(1))), Vec3<Real>{});
}

template <class Real>
ALHAZEN_HD BsdfValue<Real> evaluate_glass(const GlassBsdf<Real>& glass, const Vec3<Real>& wo, const Vec3<Real>& wi) {
  if (wo.z == 0 || wi.z == 0) return {};
  const DielectricBsdf<Real, Vec2<Real>>& interface = glass.interface;
  const bool reflects = wo.z * wi.z > 0, within = wo.z < 0;
  BsdfValue<Real> v;
  DielectricFacet<Real> f;
  if (dielectric_facet(interface, wo, wi, f)) {
    const Vec3<Real> reflectance = glass_reflectance(glass, f.rate, f.total);
    for (int c = 0; c < 3; ++c) v.value[c] = scattering_density(f, reflectance[c]);
    v.pdf = scattering_density(f, glass_reflection_rate(reflectance));
  }
  const GlassMultiple<Real> multiple = evaluate_glass_lobe(
      interface.grid, interface.ior, glass_lobe(interface.grid, interface.ior, within), wi, reflects);
  const Vec3<Real> missing = glass_missing(glass, wo);
  v.value += missing * multiple.value;
  v.pdf += (missing.x + missing.y + missing.z) * (Real(1) / 3) * multiple.pdf;
  if (!reflects)
    v.value *= glass.through * (1 / sqr(index_beyond(interface.ior, within)));
  else if (!within)
    v.value *= glass.tint;
  return v;
}

/// Samples a direction; returns zero if there is none. evaluate_glass gives its value and density.
template <class Real>
ALHAZEN_HD Vec3<Real> sample_glass(const GlassBsdf<Real>& glass, const Vec3<Real>& wo, Real u_lobe,
                                   const Vec2<Real>& u) {
  const DielectricBsdf<Real, Vec2<Real>>& interface = glass.interface;
  const auto rate = [&](Real fresnel, bool total) {
    return glass_reflection_rate(glass_reflectance(glass, fresnel, total));
  };
  DielectricFacet<Real> f;
  const Vec3<Real> wi = sample_dielectric_facet(interface, wo, rate, u_lobe, u, f);
  return is_zero(wi) ? sample_glass_lobe(interface.grid, interface.ior, wo, u_lobe, further_numbers(u)) : wi;
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

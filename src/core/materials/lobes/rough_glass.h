#pragma once

// Rough glass that conserves energy: reflection and refraction at GGX microfacets (core/materials/dielectric.h),
// divided by the directional albedo of single scattering (Turquin 2019, "Practical multiple scattering compensation for
// microfacet models"). A coating may change the reflectance of the microfacets; they transmit the rest.

#include "core/materials/dielectric.h"
#include "core/materials/lobes/albedo_grid.h"

namespace ALHAZEN_CORE {

/// Quantities in an AlbedoGrid of glass, first from outside, then the same from within. If the reflectance of
/// microfacets is c + s * F, with the Fresnel reflectance F, and 1 on total internal reflection, the albedo of single
/// scattering is bare + c * by_constant + s * by_fresnel.
struct GlassGrid {
  static constexpr uint32_t bare = 0, by_constant = 1, by_fresnel = 2;
  static constexpr uint32_t from_within = 3;
  static constexpr uint32_t count = 6;
};

template <class Real>
struct GlassBsdf {
  DielectricBsdf<Real, Vec2<Real>> interface;
  Vec3<Real> constant, by_fresnel;  ///< reflectance of microfacets: constant + by_fresnel * F
  Vec3<Real> tint;                  ///< factor on reflection outside; the rest of it is absorbed
  Vec3<Real> through;               ///< factor on transmission
  AlbedoGridPlace<Real> albedo;
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

/// Returns the factor that makes the directional albedo for `wo` equal to 1.
template <class Real>
ALHAZEN_HD Vec3<Real> glass_compensation(const GlassBsdf<Real>& glass, const Vec3<Real>& wo) {
  const bool within = wo.z < 0;
  const GridDirection<Real> d = grid_direction(glass.albedo, Vec3<Real>{wo.x, wo.y, std::abs(wo.z)},
                                               within ? 1 / glass.interface.ior : glass.interface.ior);
  const uint32_t first = within ? GlassGrid::from_within : 0;
  const Vec3<Real> kept = splat(grid_albedo(glass.albedo, first + GlassGrid::bare, d)) +
                          glass.constant * grid_albedo(glass.albedo, first + GlassGrid::by_constant, d) +
                          glass.by_fresnel * grid_albedo(glass.albedo, first + GlassGrid::by_fresnel, d);
  return splat(Real(1)) / max(kept, splat(Real(0.01)));
}

template <class Real>
ALHAZEN_HD BsdfValue<Real> evaluate_glass(const GlassBsdf<Real>& glass, const Vec3<Real>& wo, const Vec3<Real>& wi) {
  DielectricFacet<Real> f;
  if (wo.z == 0 || wi.z == 0 || !dielectric_facet(glass.interface, wo, wi, f)) return {};
  const Vec3<Real> reflectance = glass_reflectance(glass, f.rate, f.total);
  const Real rate = glass_reflection_rate(reflectance);
  BsdfValue<Real> v;
  if (f.reflects) {
    v.value = reflectance * (f.d * f.g2 / (4 * f.cos_n));
    if (wo.z > 0) v.value *= glass.tint;
    v.pdf = rate * f.density / (4 * f.cos_o);
  } else {
    const Real jacobian = -f.cos_i / sqr(f.cos_i + f.cos_o / f.eta);
    v.value =
        (splat(Real(1)) - reflectance) * glass.through * (f.d * f.g2 * jacobian * f.cos_o / (f.cos_n * f.eta * f.eta));
    v.pdf = (1 - rate) * f.density * jacobian;
  }
  v.value *= glass_compensation(glass, wo);
  return v;
}

/// Samples a direction; returns zero if there is none. evaluate_glass gives its value and density.
template <class Real>
ALHAZEN_HD Vec3<Real> sample_glass(const GlassBsdf<Real>& glass, const Vec3<Real>& wo, Real u_lobe,
                                   const Vec2<Real>& u) {
  const DielectricBranches<Real> branches = dielectric_branches(glass.interface, wo, u);
  const bool total = !(branches.reflected_rate < 1);
  const Real rate = glass_reflection_rate(glass_reflectance(glass, branches.reflected_rate, total));
  return u_lobe < rate ? branches.reflected.direction : branches.refracted.direction;
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

#pragma once

// Directional albedo of rough glass, from grids, and compensation for multiple scattering among its microfacets.
// Single scattering of a pair of directions is scaled by the smaller of the factors 1 / albedo that each of them would
// need (Turquin 2019, "Practical multiple scattering compensation for microfacet models", uses that of the outgoing
// direction alone). That is reciprocal, gains no energy, and keeps light straight where the index approaches 1. What
// is still missing, mostly light that is reflected within the denser side, is added by a lobe after Kulla and Conty
// (2017, "Revisiting Physically Based Shading at Imageworks"), which reflects and transmits.

#include "core/materials/lobes/albedo_grid.h"
#include "core/sampling/warp.h"

namespace ALHAZEN_CORE {

/// Quantities in an AlbedoGrid of glass, first from outside, then the same from within. If the reflectance of
/// microfacets is c + s * F, with the Fresnel reflectance F, and 1 on total internal reflection, then scaled single
/// scattering and the lobe together have the albedo 1 + c * by_constant + (s - 1) * by_fresnel.
struct GlassGrid {
  static constexpr uint32_t single = 0;   ///< albedo of single scattering
  static constexpr uint32_t missing = 1;  ///< what is missing after single scattering is scaled
  static constexpr uint32_t by_constant = 2, by_fresnel = 3;
  static constexpr uint32_t from_within = 4;
  static constexpr uint32_t count = 8;
};

/// Terms of one direction.
template <class Real>
struct GlassAlbedo {
  Real single, missing;
};

/// A grid of glass of index `ior`, inside relative to outside, and a direction located in it.
template <class Real>
struct GlassGridDirection {
  uint32_t first;  ///< of the quantities of the side
  GridDirection<Real> direction;
};

template <class Real>
ALHAZEN_HD GlassGridDirection<Real> glass_direction(const AlbedoGridPlace<Real>& grid, Real ior, const Vec3<Real>& w) {
  const bool within = w.z < 0;
  return {within ? GlassGrid::from_within : 0,
          grid_direction(grid, Vec3<Real>{w.x, w.y, std::abs(w.z)}, within ? 1 / ior : ior)};
}

template <class Real>
ALHAZEN_HD GlassAlbedo<Real> glass_albedo(const AlbedoGridPlace<Real>& grid, const GlassGridDirection<Real>& d) {
  return {grid_albedo(grid, d.first + GlassGrid::single, d.direction),
          grid_albedo(grid, d.first + GlassGrid::missing, d.direction)};
}

template <class Real>
ALHAZEN_HD GlassAlbedo<Real> glass_albedo(const AlbedoGridPlace<Real>& grid, Real ior, const Vec3<Real>& w) {
  return glass_albedo(grid, glass_direction(grid, ior, w));
}

/// Returns the factor on single scattering between two directions.
template <class Real>
ALHAZEN_HD Real single_scattering_scale(const GlassAlbedo<Real>& o, const GlassAlbedo<Real>& i) {
  return 1 / max(max(o.single, i.single), Real(0.01));
}

/// Returns the mean over all directions of the Fresnel reflectance from the thinner side (the fit of Kulla and Conty
/// 2017).
template <class Real>
ALHAZEN_HD Real mean_fresnel(Real ior) {
  const Real eta = ior < 1 ? 1 / ior : ior;
  return (eta - 1) / (Real(4.08567) + Real(1.00071) * eta);
}

/// Below this mean of the missing fraction the lobe is weakened: on nearly smooth surfaces it is a spike at the horizon
/// or at the critical angle, which sampling rarely finds. At most 5e-4 of the light is lost.
template <class Real>
inline constexpr Real min_mean_of_glass_lobe = Real(2e-3);

/// The lobe for light that leaves on one side. For the fractions missing along both directions m(o) and m(i), it is
/// `reflection` or `transmission` times m(o) m(i) |cos i| / pi, and its albedo is m(o).
template <class Real>
struct GlassLobe {
  Real reflected;  ///< fraction of its light that it reflects
  Real reflection, transmission;
};

/// `within`: light leaves on the inner side. Reciprocity demands that as much light crosses in both directions, so each
/// side transmits at most what the other side misses, the mean missing fractions being weighted by the squared indices.
/// Less crosses if microfacets reflect: missing light scatters at least twice, and is not transmitted if it is
/// reflected each time.
template <class Real>
ALHAZEN_HD GlassLobe<Real> glass_lobe(const AlbedoGridPlace<Real>& grid, Real ior, bool within) {
  const Real outside = grid_mean(grid, GlassGrid::missing);
  const Real inside = grid_mean(grid, GlassGrid::from_within + GlassGrid::missing);
  const Real own = within ? inside : outside, index2 = ior * ior;
  const Real weighted_own = within ? inside * index2 : own, weighted_other = within ? outside : inside * index2;
  const Real crossing = 1 - sqr(mean_fresnel(ior));
  const Real transmitted = weighted_other < weighted_own ? crossing * (weighted_other / weighted_own) : crossing;
  GlassLobe<Real> lobe;
  lobe.reflected = 1 - transmitted;
  lobe.reflection = lobe.reflected / max(own, min_mean_of_glass_lobe<Real>);
  lobe.transmission =
      crossing * (within ? index2 : Real(1)) / max(max(weighted_own, weighted_other), min_mean_of_glass_lobe<Real>);
  return lobe;
}

/// Value and density of the lobe.
template <class Real>
struct GlassMultiple {
  Real value, pdf;
};

/// Evaluates f * |cos| of the lobe, and its density if it is sampled with the probability `o.missing`.
template <class Real>
ALHAZEN_HD GlassMultiple<Real> evaluate_glass_lobe(const GlassLobe<Real>& lobe, const GlassAlbedo<Real>& o,
                                                   const GlassAlbedo<Real>& i, Real cos_i, bool reflects) {
  const Real lambert = std::abs(cos_i) * inv_pi<Real> * o.missing;
  return {lambert * i.missing * (reflects ? lobe.reflection : lobe.transmission),
          lambert * (reflects ? lobe.reflected : 1 - lobe.reflected)};
}

/// Samples the lobe, for light that leaves along `wo`.
template <class Real>
ALHAZEN_HD Vec3<Real> sample_glass_lobe(const GlassLobe<Real>& lobe, const Vec3<Real>& wo, Real u_side,
                                        const Vec2<Real>& u) {
  Vec3<Real> wi = sample_cosine_hemisphere(u);
  if ((u_side < lobe.reflected) != (wo.z > 0)) wi.z = -wi.z;
  return wi;
}

}  // namespace ALHAZEN_CORE

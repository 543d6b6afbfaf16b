#pragma once

// Directional albedo of GGX microfacets, from grids, and compensation for multiple scattering among them (Kulla and
// Conty 2017, "Revisiting Physically Based Shading at Imageworks").

#include "core/materials/lobes/albedo_grid.h"

namespace ALHAZEN_CORE {

/// Quantities in an AlbedoGrid of GGX. With the Fresnel term f0 (1 - s) + f90 s, where s = (1 - cos)^5, the albedo is
/// f0 * base + f90 * edge.
struct GgxGrid {
  static constexpr uint32_t base = 0, edge = 1;
};

/// Albedo of GGX for one direction, or its mean over all: f0 * base + f90 * edge.
template <class Real>
struct GgxAlbedo {
  Real base, edge;

  ALHAZEN_HD Real all() const { return base + edge; }
  /// Returns the fraction of light lost by single scattering if f0 and f90 are 1, clamped to >= 0 against rounding.
  ALHAZEN_HD Real missing() const { return max(Real(0), 1 - (base + edge)); }
};

template <class Real>
ALHAZEN_HD GgxAlbedo<Real> ggx_albedo(const AlbedoGridPlace<Real>& grid, const Vec3<Real>& w) {
  const GridDirection<Real> d = grid_direction(grid, w, Real(1));
  return {grid_albedo(grid, GgxGrid::base, d), grid_albedo(grid, GgxGrid::edge, d)};
}

template <class Real>
ALHAZEN_HD GgxAlbedo<Real> mean_ggx_albedo(const AlbedoGridPlace<Real>& grid) {
  return {grid_mean(grid, GgxGrid::base), grid_mean(grid, GgxGrid::edge)};
}

/// The lobe of Kulla and Conty is the product of the fractions missing along both directions, divided by their mean
/// over all directions. On nearly smooth surfaces the mean is almost 0, and the lobe is a spike at the horizon that
/// sampling rarely finds: below this mean, the lobe is weakened and the remaining energy is added to single scattering.
template <class Real>
inline constexpr Real min_mean_missing = Real(1e-3);

/// Returns the factor on single scattering, with directional albedo `single`, that adds the energy missing from the
/// weakened lobe.
template <class Real>
ALHAZEN_HD Real single_scattering_scale(Real single, Real missing, Real mean_missing) {
  if (mean_missing >= min_mean_missing<Real>) return 1;
  return 1 + missing * (1 - mean_missing / min_mean_missing<Real>) / max(single, Real(0.1));
}

}  // namespace ALHAZEN_CORE

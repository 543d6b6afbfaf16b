#pragma once

// How much light GGX microfacets reflect, from grids, and what multiple scattering among them gives back (Kulla and
// Conty 2017, "Revisiting Physically Based Shading at Imageworks").

#include "core/materials/lobes/albedo_grid.h"

namespace ALHAZEN_CORE {

/// What an AlbedoGrid of GGX holds. Where its Fresnel term is  f0 (1 - s) + f90 s,  s = (1 - cos)^5,  its albedo is
/// f0 * base + f90 * edge.
struct GgxGrid {
  static constexpr uint32_t base = 0, edge = 1;
};

/// What GGX reflects from a direction, or from all of them: f0 * base + f90 * edge.
template <class Real>
struct GgxAlbedo {
  Real base, edge;

  ALHAZEN_HD Real all() const { return base + edge; }
  /// Share of light left where both Fresnel terms are 1; 0 or more, whatever rounding does.
  ALHAZEN_HD Real missing() const { return larger(Real(0), 1 - (base + edge)); }
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

/// Kulla and Conty's lobe has light of all directions leave by what is missing along them, over the mean of that. Near
/// smooth surfaces the mean is next to nothing, and the lobe a spike along the horizon that sampling hardly finds:
/// below this the lobe is weakened, and the rest of the light added to single scattering.
template <class Real>
inline constexpr Real least_mean_missing = Real(1e-3);

/// Factor on single scattering, whose albedo from a direction is `single`, for what the weakened lobe leaves out.
template <class Real>
ALHAZEN_HD Real single_scattering_scale(Real single, Real missing, Real mean_missing) {
  if (mean_missing >= least_mean_missing<Real>) return 1;
  return 1 + missing * (1 - mean_missing / least_mean_missing<Real>) / larger(single, Real(0.1));
}

}  // namespace ALHAZEN_CORE

#pragma once

// Tables of directional albedo by cosine and, for anisotropic microfacets, by azimuth. A grid holds a block for each
// tabulated alpha or pair of alphas, and a block holds several quantities: those of GGX, of glass from either side, of
// sheen, or of coats. compile/tables/albedo_grids.cpp computes the grids when a scene is compiled.

#include "core/materials/lobes/albedo_table.h"

namespace ALHAZEN_CORE {

inline constexpr uint32_t grid_cosines = 64;
/// Nodes by alpha_coordinate if the roughness varies over the surface: of equal alphas, and of each alpha of a pair.
inline constexpr uint32_t grid_alphas = 32, grid_alpha_pairs = 12;
/// Nodes of the azimuth if the alphas differ: of a constant pair, and of a pair that varies.
inline constexpr uint32_t grid_azimuths = 25, grid_azimuths_of_pairs = 9;

/// Location of a grid in SceneView::albedo_tables. A block has `quantities` times `azimuths` rows of `grid_cosines`
/// values, followed by the cosine-weighted mean of each quantity over all directions.
struct AlbedoGridRecord {
  uint32_t first, quantities, azimuths;
  uint32_t alphas_u, alphas_v;  ///< 1: constant. Equal alphas vary along u only
};

ALHAZEN_HD constexpr uint32_t grid_block_size(uint32_t quantities, uint32_t azimuths) {
  return quantities * (azimuths * grid_cosines + 1);
}

/// A block, and the steps to its neighbours at larger alphas with their interpolation weights.
template <class Real>
struct AlbedoGridPlace {
  const Real* block;
  uint32_t quantities, azimuths;
  uint32_t step_u, step_v;  ///< 0 if the alpha is constant
  Real weight_u, weight_v;
};

template <class Real>
ALHAZEN_HD Real alpha_weight(Real alpha, uint32_t alphas, uint32_t& node) {
  node = 0;
  return alphas > 1 ? node_weight(alpha_coordinate(alpha), alphas, node) : Real(0);
}

template <class Real>
ALHAZEN_HD AlbedoGridPlace<Real> grid_place(const Real* tables, const AlbedoGridRecord& grid, const Vec2<Real>& alpha) {
  AlbedoGridPlace<Real> place{tables + grid.first, grid.quantities, grid.azimuths, 0, 0, 0, 0};
  const uint32_t size = grid_block_size(grid.quantities, grid.azimuths);
  uint32_t u = 0, v = 0;
  place.weight_u = alpha_weight(alpha.x, grid.alphas_u, u);
  place.weight_v = alpha_weight(alpha.y, grid.alphas_v, v);
  place.step_v = grid.alphas_v > 1 ? size : 0;
  place.step_u = grid.alphas_u > 1 ? size * grid.alphas_v : 0;
  place.block += (u * grid.alphas_v + v) * size;
  return place;
}

/// Location of a direction between the nodes of a row and of the azimuth.
template <class Real>
struct GridDirection {
  uint32_t node, azimuth;
  Real weight, azimuth_weight;
};

/// Locates the azimuth of a direction by its tangential coordinates.
template <class Real>
ALHAZEN_HD void locate_azimuth(const AlbedoGridPlace<Real>& place, Real x, Real y, GridDirection<Real>& d) {
  if (place.azimuths == 1) return;
  // Nodes are dense near the tangent and the bitangent, where the projected roughness changes most.
  x = std::abs(x), y = std::abs(y);
  const Real along = x + y > 0 ? (x - y) / (x + y) : Real(0);
  d.azimuth_weight = node_weight(std::acos(clamp(-along, Real(-1), Real(1))) * inv_pi<Real>, place.azimuths, d.azimuth);
}

/// Locates the direction `w`, with `w.z` > 0; `ior` is that of cosine_coordinate.
template <class Real>
ALHAZEN_HD GridDirection<Real> grid_direction(const AlbedoGridPlace<Real>& place, const Vec3<Real>& w, Real ior) {
  GridDirection<Real> d{0, 0, 0, 0};
  d.weight = node_weight(cosine_coordinate(w.z, ior, grid_cosines), grid_cosines, d.node);
  locate_azimuth(place, w.x, w.y, d);
  return d;
}

/// Interpolates a quantity between the blocks; `value` looks it up in one block.
template <class Real, class Value>
ALHAZEN_HD Real over_blocks(const AlbedoGridPlace<Real>& place, const Value& value) {
  if (place.step_v == 0)
    return (1 - place.weight_u) * value(place.block) + place.weight_u * value(place.block + place.step_u);
  Real sum = 0;
  for (uint32_t corner = 0; corner < 4; ++corner) {
    const Real weight =
        (corner & 1 ? place.weight_u : 1 - place.weight_u) * (corner & 2 ? place.weight_v : 1 - place.weight_v);
    if (!(weight > 0)) continue;
    sum += weight * value(place.block + (corner & 1 ? place.step_u : 0) + (corner & 2 ? place.step_v : 0));
  }
  return sum;
}

template <class Real>
ALHAZEN_HD Real grid_albedo(const AlbedoGridPlace<Real>& place, uint32_t quantity, const GridDirection<Real>& d) {
  return over_blocks(place, [&](const Real* block) {
    const Real* row = block + (quantity * place.azimuths + d.azimuth) * grid_cosines + d.node;
    const Real low = row[0] + (row[1] - row[0]) * d.weight;
    if (place.azimuths == 1) return low;
    row += grid_cosines;
    const Real high = row[0] + (row[1] - row[0]) * d.weight;
    return low + (high - low) * d.azimuth_weight;
  });
}

template <class Real>
ALHAZEN_HD Real grid_mean(const AlbedoGridPlace<Real>& place, uint32_t quantity) {
  return over_blocks(
      place, [&](const Real* block) { return block[place.quantities * place.azimuths * grid_cosines + quantity]; });
}

}  // namespace ALHAZEN_CORE

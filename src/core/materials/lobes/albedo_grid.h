#pragma once

// Tables of directional albedo by cosine and, for microfacets whose two alphas differ, by azimuth. A grid holds one
// block for each alpha or pair of them that a material may have, and a block several quantities: those of GGX, of glass
// seen from either side, of sheen, of coats. compile/tables/albedo_grids.cpp computes grids when a scene is compiled.

#include "core/materials/lobes/albedo_table.h"

namespace ALHAZEN_CORE {

inline constexpr uint32_t grid_cosines = 64;
/// Nodes by alpha_coordinate where a roughness varies over the surface: of equal alphas, and of either of a pair.
inline constexpr uint32_t grid_alphas = 32, grid_alpha_pairs = 12;
/// Nodes of the azimuth where the alphas differ: of a constant pair, and of pairs that vary.
inline constexpr uint32_t grid_azimuths = 25, grid_azimuths_of_pairs = 9;

/// Where a grid is stored in SceneView::albedo_tables. A block is `quantities` times `azimuths` rows of `grid_cosines`
/// values, and after these the mean of each quantity over all directions, weighted by the cosine.
struct AlbedoGridRecord {
  uint32_t first, quantities, azimuths;
  uint32_t alphas_u, alphas_v;  ///< 1: constant. Equal alphas vary along u alone
};

ALHAZEN_HD constexpr uint32_t grid_block_size(uint32_t quantities, uint32_t azimuths) {
  return quantities * (azimuths * grid_cosines + 1);
}

/// A block and its neighbours towards larger alphas, with the weights of these.
template <class Real>
struct AlbedoGridPlace {
  const Real* block;
  uint32_t quantities, azimuths;
  uint32_t step_u, step_v;  ///< 0 where an alpha is constant
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

/// A direction among the nodes of a row and of the azimuths.
template <class Real>
struct GridDirection {
  uint32_t node, azimuth;
  Real weight, azimuth_weight;
};

/// `w.z` > 0; `ior` as that of cosine_coordinate.
template <class Real>
ALHAZEN_HD GridDirection<Real> grid_direction(const AlbedoGridPlace<Real>& place, const Vec3<Real>& w, Real ior) {
  GridDirection<Real> d{0, 0, 0, 0};
  d.weight = node_weight(cosine_coordinate(w.z, ior, grid_cosines), grid_cosines, d.node);
  if (place.azimuths == 1) return d;
  // Dense along the tangent and the bitangent, where the roughness that is seen changes most.
  const Real x = std::abs(w.x), y = std::abs(w.y);
  const Real along = x + y > 0 ? (x - y) / (x + y) : Real(0);
  d.azimuth_weight = node_weight(std::acos(clamp(-along, Real(-1), Real(1))) * inv_pi<Real>, place.azimuths, d.azimuth);
  return d;
}

/// Sum of a quantity over the blocks, each by its weight; `value` looks it up in one.
template <class Real, class Value>
ALHAZEN_HD Real over_blocks(const AlbedoGridPlace<Real>& place, const Value& value) {
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

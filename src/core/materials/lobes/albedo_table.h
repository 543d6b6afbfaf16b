#pragma once

// Tables of directional albedo: the share of light that a rough dielectric interface sends back by single scattering,
// by the cosine of the direction and by alpha. compile/tables/albedo_tables.cpp computes them when a scene with layered
// materials is compiled; what else has an albedo is in the grids of core/materials/lobes/albedo_grid.h.

#include "core/math/scalar.h"
#include "core/math/vec.h"

namespace ALHAZEN_CORE {

/// Tables begin at this alpha, and smooth layers have it.
template <class Real>
inline constexpr Real least_layered_alpha = Real(1.5e-3);

template <class Real>
ALHAZEN_HD Real layered_alpha(Real alpha) {
  return larger(alpha, least_layered_alpha<Real>);
}

/// Beyond these an interface reflects all light but a ten-thousandth, and rounding would have the rest.
template <class Real>
inline constexpr Real min_layered_ior = Real(0.01);
template <class Real>
inline constexpr Real max_layered_ior = Real(1e6);

/// A table is `albedo_side` rows by alpha_coordinate, each of as many values by cosine_coordinate; after them as many
/// means over all directions, weighted by the cosine, one a row.
inline constexpr uint32_t albedo_side = 32;
inline constexpr uint32_t albedo_table_size = albedo_side * albedo_side + albedo_side;
/// Total reflection ends at this node of a row where the medium beyond the interface is the thinner one.
ALHAZEN_HD constexpr uint32_t critical_node(uint32_t nodes) { return nodes / 2 - 1; }

/// What stands after the rows of a table of what a coat lets through, for each alpha.
struct CoatColumns {
  static constexpr uint32_t back = 0;    ///< share of diffuse light from below that the coat sends down again
  static constexpr uint32_t escape = 1;  ///< the rest of it, precise where that is next to nothing
  static constexpr uint32_t scale = 2;   ///< factor on what the reciprocity of an interface lets out; mostly 1
  static constexpr uint32_t mean = 3;    ///< over all directions
  static constexpr uint32_t count = 4;
};

/// A cosine as a coordinate from 0 to 1 in a row of that many nodes, dense where albedos bend: at grazing angles, and
/// most on both sides of the critical angle where `ior`, the index beyond the interface relative to this side, is below
/// 1: nearly smooth interfaces go over from total reflection within their alpha.
template <class Real>
ALHAZEN_HD Real cosine_coordinate(Real cosine, Real ior, uint32_t nodes) {
  const Real c = clamp(cosine, Real(0), Real(1));
  if (ior >= 1) return std::sqrt(c);
  const Real critical = static_cast<Real>(critical_node(nodes)) / static_cast<Real>(nodes - 1);
  const Real cos2_t = 1 - (1 - c * c) / (ior * ior);
  if (cos2_t > 0) return critical + (1 - critical) * std::sqrt(std::sqrt(cos2_t));
  const Real below = clamp(1 - c / safe_sqrt(1 - ior * ior), Real(0), Real(1));
  return critical * safe_sqrt(1 - std::sqrt(std::sqrt(below)));
}

/// An alpha as a coordinate from 0 to 1, even in its square root.
template <class Real>
ALHAZEN_HD Real alpha_coordinate(Real alpha) {
  constexpr Real least = Real(0.03872983346207417);  // the root of least_layered_alpha
  return (std::sqrt(clamp(alpha, least_layered_alpha<Real>, Real(1))) - least) * (1 / (1 - least));
}

/// Weight of the node after `node`, which receives where `coordinate`, from 0 to 1, lies among `nodes`.
template <class Real>
ALHAZEN_HD Real node_weight(Real coordinate, uint32_t nodes, uint32_t& node) {
  const Real x = coordinate * static_cast<Real>(nodes - 1);
  node = static_cast<uint32_t>(x);
  node = node > nodes - 2 ? nodes - 2 : node;
  return x - static_cast<Real>(node);
}

/// `ior`: of the interface that the table is of.
template <class Real>
ALHAZEN_HD Real lookup_albedo(const Real* table, Real cosine, Real alpha, Real ior) {
  uint32_t i, j;
  const Real s = node_weight(cosine_coordinate(cosine, ior, albedo_side), albedo_side, i);
  const Real t = node_weight(alpha_coordinate(alpha), albedo_side, j);
  const Real* row = table + j * albedo_side + i;
  const Real low = row[0] + (row[1] - row[0]) * s;
  const Real high = row[albedo_side] + (row[albedo_side + 1] - row[albedo_side]) * s;
  return low + (high - low) * t;
}

/// A value for each alpha that is stored after the rows: `column` 0 is mostly the mean over all directions.
template <class Real>
ALHAZEN_HD Real mean_albedo(const Real* table, Real alpha, uint32_t column = 0) {
  uint32_t j;
  const Real t = node_weight(alpha_coordinate(alpha), albedo_side, j);
  const Real* means = table + (albedo_side + column) * albedo_side + j;
  return means[0] + (means[1] - means[0]) * t;
}

}  // namespace ALHAZEN_CORE

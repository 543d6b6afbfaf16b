#pragma once

// Tables of directional albedo: the fraction of light that a rough dielectric interface reflects by single scattering,
// by the cosine of the direction and by alpha. compile/tables/albedo_tables.cpp computes them when a scene with layered
// materials is compiled. Other albedos are in the grids of core/materials/lobes/albedo_grid.h.

#include "core/math/scalar.h"
#include "core/math/vec.h"

namespace ALHAZEN_CORE {

/// The smallest alpha of the tables, which smooth layers use.
template <class Real>
inline constexpr Real min_layered_alpha = Real(1.5e-3);

template <class Real>
ALHAZEN_HD Real layered_alpha(Real alpha) {
  return max(alpha, min_layered_alpha<Real>);
}

/// Limits of the index of refraction; beyond them, an interface transmits less than 1e-4 of the light, which would be
/// lost to rounding.
template <class Real>
inline constexpr Real min_layered_ior = Real(0.01);
template <class Real>
inline constexpr Real max_layered_ior = Real(1e6);

/// A table has `albedo_side` rows by alpha_coordinate, each of `albedo_side` values by cosine_coordinate, followed by
/// the cosine-weighted mean of each row over all directions.
inline constexpr uint32_t albedo_side = 32;
inline constexpr uint32_t albedo_table_size = albedo_side * albedo_side + albedo_side;
/// Returns the node of a row at which total internal reflection ends, if the index beyond the interface is the lower.
ALHAZEN_HD constexpr uint32_t critical_node(uint32_t nodes) { return nodes / 2 - 1; }

/// Columns after the rows of a coat transmittance table, each with one value per alpha.
struct CoatColumns {
  static constexpr uint32_t back = 0;    ///< fraction of diffuse light from below that the coat reflects
  static constexpr uint32_t escape = 1;  ///< 1 - back, precise if that is almost 0
  static constexpr uint32_t scale = 2;   ///< factor on the exit transmittance given by reciprocity; usually 1
  static constexpr uint32_t mean = 3;    ///< cosine-weighted mean over all directions
  static constexpr uint32_t count = 4;
};

/// Maps a cosine to a coordinate in [0, 1] along a row of `nodes`. `ior` is the index beyond the interface relative to
/// this side. Nodes are dense where albedos curve: at grazing angles and, if `ior` < 1, above all on both sides of the
/// critical angle, where total reflection by nearly smooth interfaces ends within about their alpha.
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

/// Returns the square of the cosine whose coordinate is that of a node: the inverse of cosine_coordinate.
template <class Real>
ALHAZEN_HD Real squared_cosine_of_node(uint32_t node, Real ior, uint32_t nodes) {
  const uint32_t critical = critical_node(nodes);
  if (ior >= 1) return sqr(sqr(static_cast<Real>(node) / static_cast<Real>(nodes - 1)));
  if (node > critical)
    return 1 - ior * ior * (1 - sqr(sqr(static_cast<Real>(node - critical) / static_cast<Real>(nodes - 1 - critical))));
  return (1 - ior * ior) * sqr(1 - sqr(sqr(1 - sqr(static_cast<Real>(node) / static_cast<Real>(critical)))));
}

/// Maps an alpha to a coordinate in [0, 1], linear in its square root.
template <class Real>
ALHAZEN_HD Real alpha_coordinate(Real alpha) {
  constexpr Real least = Real(0.03872983346207417);  // sqrt(min_layered_alpha)
  return (std::sqrt(clamp(alpha, min_layered_alpha<Real>, Real(1))) - least) * (1 / (1 - least));
}

/// Returns the interpolation weight of the node after `node`, which receives the last node not beyond `coordinate`, in
/// [0, 1].
template <class Real>
ALHAZEN_HD Real node_weight(Real coordinate, uint32_t nodes, uint32_t& node) {
  const Real x = coordinate * static_cast<Real>(nodes - 1);
  node = static_cast<uint32_t>(x);
  node = node > nodes - 2 ? nodes - 2 : node;
  return x - static_cast<Real>(node);
}

/// Interpolates a table bilinearly; `ior` is that of the interface of the table.
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

/// Interpolates a column after the rows by alpha. `column` 0 of an interface table is the mean over all directions.
template <class Real>
ALHAZEN_HD Real mean_albedo(const Real* table, Real alpha, uint32_t column = 0) {
  uint32_t j;
  const Real t = node_weight(alpha_coordinate(alpha), albedo_side, j);
  const Real* means = table + (albedo_side + column) * albedo_side + j;
  return means[0] + (means[1] - means[0]) * t;
}

}  // namespace ALHAZEN_CORE

#pragma once

// Tables of directional albedo: the share of light that a rough dielectric interface sends back by single scattering,
// by the cosine of the direction and by alpha. scene/albedo_tables.cpp computes them when a scene with layered
// materials is flattened; what else has an albedo is in the grids of core/materials/albedo_grid.h.

#include "core/math/scalar.h"
#include "core/math/vec.h"

namespace ALHAZEN_CORE {

/// A table is `albedo_side` rows, one a value of sqrt(alpha) from 0 to 1, each of as many values by cosine_coordinate;
/// after them as many means over all directions, weighted by the cosine, one a row.
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
/// on both sides of the critical angle where `ior`, the index beyond the interface relative to this side, is below 1.
template <class Real>
ALHAZEN_HD Real cosine_coordinate(Real cosine, Real ior, uint32_t nodes) {
  const Real c = clamp(cosine, Real(0), Real(1));
  if (ior >= 1) return std::sqrt(c);
  const Real critical = static_cast<Real>(critical_node(nodes)) / static_cast<Real>(nodes - 1);
  const Real cos2_t = 1 - (1 - c * c) / (ior * ior);
  if (cos2_t > 0) return critical + (1 - critical) * std::sqrt(std::sqrt(cos2_t));
  const Real critical_cosine = safe_sqrt(1 - ior * ior);
  return critical * inv_pi<Real> * std::acos(clamp(1 - 2 * c / critical_cosine, Real(-1), Real(1)));
}

/// `ior`: of the interface that the table is of.
template <class Real>
ALHAZEN_HD Real lookup_albedo(const Real* table, Real cosine, Real alpha, Real ior) {
  constexpr Real last = static_cast<Real>(albedo_side - 1);
  const Real x = cosine_coordinate(cosine, ior, albedo_side) * last,
             y = std::sqrt(clamp(alpha, Real(0), Real(1))) * last;
  uint32_t i = static_cast<uint32_t>(x), j = static_cast<uint32_t>(y);
  i = i > albedo_side - 2 ? albedo_side - 2 : i;
  j = j > albedo_side - 2 ? albedo_side - 2 : j;
  const Real s = x - static_cast<Real>(i), t = y - static_cast<Real>(j);
  const Real* row = table + j * albedo_side + i;
  const Real low = row[0] + (row[1] - row[0]) * s;
  const Real high = row[albedo_side] + (row[albedo_side + 1] - row[albedo_side]) * s;
  return low + (high - low) * t;
}

/// A value for each alpha that is stored after the rows: `column` 0 is mostly the mean over all directions.
template <class Real>
ALHAZEN_HD Real mean_albedo(const Real* table, Real alpha, uint32_t column = 0) {
  const Real y = std::sqrt(clamp(alpha, Real(0), Real(1))) * static_cast<Real>(albedo_side - 1);
  uint32_t j = static_cast<uint32_t>(y);
  j = j > albedo_side - 2 ? albedo_side - 2 : j;
  const Real* means = table + (albedo_side + column) * albedo_side + j;
  return means[0] + (means[1] - means[0]) * (y - static_cast<Real>(j));
}

}  // namespace ALHAZEN_CORE

#pragma once

// Tables of directional albedo: the share of light that a layer of microfacets sends back by single scattering, by the
// cosine of the direction and by alpha. scene/albedo_tables.cpp computes them when a scene with layered materials is
// flattened.

#include "core/math/scalar.h"
#include "core/math/vec.h"

namespace ALHAZEN_CORE {

/// A table is `albedo_side` rows, one a value of sqrt(alpha) from 0 to 1, each of as many values by sqrt(cosine); after
/// them as many means over all directions, weighted by the cosine, one a row.
inline constexpr uint32_t albedo_side = 32;
inline constexpr uint32_t albedo_table_size = albedo_side * albedo_side + albedo_side;

/// What stands first in SceneView::albedo_tables. GGX whose Fresnel term is  f0 (1 - s) + f90 s,  s = (1 - cos)^5, has
/// the albedo  f0 * base + f90 * edge. Dielectric interfaces follow, a table each.
struct AlbedoTables {
  static constexpr uint32_t base = 0;
  static constexpr uint32_t edge = albedo_table_size;
  static constexpr uint32_t sheen = 2 * albedo_table_size;  ///< by roughness in place of alpha
  static constexpr uint32_t interfaces = 3 * albedo_table_size;
};

template <class Real>
ALHAZEN_HD Real lookup_albedo(const Real* table, Real cosine, Real alpha) {
  constexpr Real last = static_cast<Real>(albedo_side - 1);
  const Real x = std::sqrt(clamp(cosine, Real(0), Real(1))) * last,
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

/// Mean over all directions.
template <class Real>
ALHAZEN_HD Real mean_albedo(const Real* table, Real alpha) {
  const Real y = std::sqrt(clamp(alpha, Real(0), Real(1))) * static_cast<Real>(albedo_side - 1);
  uint32_t j = static_cast<uint32_t>(y);
  j = j > albedo_side - 2 ? albedo_side - 2 : j;
  const Real* means = table + albedo_side * albedo_side + j;
  return means[0] + (means[1] - means[0]) * (y - static_cast<Real>(j));
}

}  // namespace ALHAZEN_CORE

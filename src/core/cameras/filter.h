#pragma once

// Pixel filters by importance sampling: a sample is placed where the filter puts it and counts whole
// (Ernst, Stamminger, Greiner 2006, "Filter Importance Sampling").

#include <cstdint>

#include "core/math/vec.h"

namespace ALHAZEN_CORE {

/// [0, 1) in so many parts for each cell of a filter's table: parts are where the search for the cell begins, which
/// they mostly end too.
inline constexpr uint32_t filter_parts_per_cell = 4;

/// The box is sampled directly, other filters from one table for each axis: filter_cdf holds for x, then for y,
/// `cells` + 1 values of the cumulative distribution of |f|, `cells` signs of f, and for each of filter_parts_per_cell
/// * `cells` equal parts of [0, 1) the cell that its lowest number falls in.
template <class Real>
struct FilterRecord {
  Real x_radius = Real(0.5), y_radius = Real(0.5);  ///< pixels
  uint32_t cells = 0;                               ///< 0: box
  uint32_t has_negative = 0;                        ///< 1: weights may be -1
};

template <class Real>
struct FilterSample {
  Vec2<Real> offset;  ///< pixels from the pixel's centre
  Real weight;        ///< 1, or -1 where the filter is negative
};

template <class Real>
ALHAZEN_HD ALHAZEN_HOT Real sample_filter_axis(const Real* table, uint32_t cells, Real radius, Real u, Real& weight) {
  const Real count = static_cast<Real>(cells);
  const uint32_t part = static_cast<uint32_t>(u * (count * filter_parts_per_cell));
  uint32_t cell = static_cast<uint32_t>(table[2 * cells + 1 + part]);
  while (table[cell + 1] <= u) ++cell;
  const Real width = table[cell + 1] - table[cell];
  const Real within = width > 0 ? (u - table[cell]) / width : Real(0.5);
  weight *= table[cells + 1 + cell];
  return radius * (2 * (static_cast<Real>(cell) + within) / count - 1);
}

template <class Real>
ALHAZEN_HD ALHAZEN_HOT FilterSample<Real> sample_filter(const FilterRecord<Real>& filter, const Real* filter_cdf,
                                                        const Vec2<Real>& u) {
  FilterSample<Real> s{{}, 1};
  if (filter.cells == 0) {
    s.offset = {filter.x_radius * (2 * u.x - 1), filter.y_radius * (2 * u.y - 1)};
    return s;
  }
  s.offset.x = sample_filter_axis(filter_cdf, filter.cells, filter.x_radius, u.x, s.weight);
  s.offset.y = sample_filter_axis(filter_cdf + (2 + filter_parts_per_cell) * filter.cells + 1, filter.cells,
                                  filter.y_radius, u.y, s.weight);
  return s;
}

}  // namespace ALHAZEN_CORE

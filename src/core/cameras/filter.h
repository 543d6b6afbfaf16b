#pragma once

// Pixel filters by importance sampling: sample positions are distributed like the filter, and each sample has weight 1
// (Ernst, Stamminger, Greiner 2006, "Filter Importance Sampling").

#include <cstdint>

#include "core/math/vec.h"

namespace ALHAZEN_CORE {

/// Number of equal parts of [0, 1) per cell of a filter's table. Each part stores the cell at which the search begins;
/// in most cases that is the cell looked for.
inline constexpr uint32_t filter_parts_per_cell = 4;

/// The box filter is sampled directly, others by one table per axis. `filter_cdf` holds, for x and then for y,
/// `cells` + 1 values of the cumulative distribution of |f|, `cells` signs of f, and for each of filter_parts_per_cell
/// * `cells` equal parts of [0, 1) the cell that contains its lower end.
template <class Real>
struct FilterRecord {
  Real x_radius = Real(0.5), y_radius = Real(0.5);  ///< pixels
  uint32_t cells = 0;                               ///< 0 for the box filter
  uint32_t has_negative = 0;                        ///< 1 if weights may be -1
};

template <class Real>
struct FilterSample {
  Vec2<Real> offset;  ///< from the pixel's centre, in pixels
  Real weight;        ///< 1, or -1 where the filter is negative
};

/// The table of one axis.
template <class Real>
struct FilterAxis {
  const Real* table;
  uint32_t cells;
  Real radius;

  /// Returns a cell at or before that of u in [0, 1), from which `find` searches.
  ALHAZEN_HD ALHAZEN_HOT uint32_t guess(Real u) const {
    const uint32_t part = static_cast<uint32_t>(u * (static_cast<Real>(cells) * filter_parts_per_cell));
    return static_cast<uint32_t>(table[2 * cells + 1 + part]);
  }
  /// Returns whether u is in a cell after `cell`.
  ALHAZEN_HD ALHAZEN_HOT bool is_after(uint32_t cell, Real u) const { return table[cell + 1] <= u; }
  /// Finds the cell of u, starting from a cell at or before it.
  ALHAZEN_HD ALHAZEN_HOT uint32_t find(uint32_t cell, Real u) const {
    while (is_after(cell, u)) ++cell;
    return cell;
  }

  ALHAZEN_HD ALHAZEN_HOT Real sign(uint32_t cell) const { return table[cells + 1 + cell]; }
  /// Offset from the pixel's centre in pixels, where `cell` contains u.
  ALHAZEN_HD ALHAZEN_HOT Real offset(uint32_t cell, Real u) const {
    const Real begin = table[cell], width = table[cell + 1] - begin;
    const Real within = width > 0 ? (u - begin) / width : Real(0.5);
    return radius * (2 * (static_cast<Real>(cell) + within) / static_cast<Real>(cells) - 1);
  }
};

template <class Real>
ALHAZEN_HD ALHAZEN_HOT FilterAxis<Real> filter_x(const FilterRecord<Real>& filter, const Real* filter_cdf) {
  return {filter_cdf, filter.cells, filter.x_radius};
}
template <class Real>
ALHAZEN_HD ALHAZEN_HOT FilterAxis<Real> filter_y(const FilterRecord<Real>& filter, const Real* filter_cdf) {
  return {filter_cdf + (2 + filter_parts_per_cell) * filter.cells + 1, filter.cells, filter.y_radius};
}

template <class Real>
ALHAZEN_HD ALHAZEN_HOT FilterSample<Real> sample_box(const FilterRecord<Real>& filter, const Vec2<Real>& u) {
  return {{filter.x_radius * (2 * u.x - 1), filter.y_radius * (2 * u.y - 1)}, 1};
}

/// The sample of u within its cells.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT FilterSample<Real> sample_cells(const FilterAxis<Real>& x, const FilterAxis<Real>& y,
                                                       uint32_t cell_x, uint32_t cell_y, const Vec2<Real>& u) {
  return {{x.offset(cell_x, u.x), y.offset(cell_y, u.y)}, x.sign(cell_x) * y.sign(cell_y)};
}

template <class Real>
ALHAZEN_HD ALHAZEN_HOT FilterSample<Real> sample_filter(const FilterRecord<Real>& filter, const Real* filter_cdf,
                                                        const Vec2<Real>& u) {
  if (filter.cells == 0) return sample_box(filter, u);
  const FilterAxis<Real> x = filter_x(filter, filter_cdf), y = filter_y(filter, filter_cdf);
  return sample_cells(x, y, x.find(x.guess(u.x), u.x), y.find(y.guess(u.y), u.y), u);
}

}  // namespace ALHAZEN_CORE

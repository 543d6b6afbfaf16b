#pragma once

// Values of many paths in structure-of-arrays form, for loops that compilers vectorize.

#include <cstdint>

#include "core/math/vec.h"

namespace ALHAZEN_CORE {

/// Rounds `count` up to the row at which loops over columns end, so that no remainder is left for narrower
/// instructions. Columns have a multiple of 16 rows; results in rows beyond `count` are unused.
constexpr uint32_t whole_rows(uint32_t count) { return (count + 15) & ~uint32_t{15}; }

template <class Real, uint32_t max_count>
struct VectorColumns {
  static_assert(whole_rows(max_count) == max_count);

  Real x[max_count]{}, y[max_count]{}, z[max_count]{};

  ALHAZEN_INLINE Vec3<Real> operator[](uint32_t i) const { return {x[i], y[i], z[i]}; }
  ALHAZEN_INLINE void set(uint32_t i, const Vec3<Real>& v) {
    x[i] = v.x;
    y[i] = v.y;
    z[i] = v.z;
  }
};

}  // namespace ALHAZEN_CORE

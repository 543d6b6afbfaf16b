#pragma once

// Values of many paths, component by component, as loops that compilers turn into SIMD instructions want them.

#include <cstdint>

#include "core/math/vec.h"

namespace ALHAZEN_CORE {

/// Loops over the first `count` rows of columns run to here, so that no rows are left over for narrower instructions.
/// Columns have a multiple of 16 rows; what stands in those beyond `count` is worked out for nothing.
constexpr uint32_t whole_rows(uint32_t count) { return (count + 15) & ~uint32_t{15}; }

template <class Real, uint32_t most>
struct VectorColumns {
  static_assert(whole_rows(most) == most);

  Real x[most]{}, y[most]{}, z[most]{};

  ALHAZEN_INLINE Vec3<Real> operator[](uint32_t i) const { return {x[i], y[i], z[i]}; }
  ALHAZEN_INLINE void set(uint32_t i, const Vec3<Real>& v) {
    x[i] = v.x;
    y[i] = v.y;
    z[i] = v.z;
  }
};

}  // namespace ALHAZEN_CORE

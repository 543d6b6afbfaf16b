#pragma once

// Values of many paths, component by component, as loops that compilers turn into SIMD instructions want them.

#include <cstdint>

#include "core/math/vec.h"

namespace ALHAZEN_CORE {

template <class Real, uint32_t most>
struct VectorColumns {
  Real x[most]{}, y[most]{}, z[most]{};

  ALHAZEN_INLINE Vec3<Real> operator[](uint32_t i) const { return {x[i], y[i], z[i]}; }
  ALHAZEN_INLINE void set(uint32_t i, const Vec3<Real>& v) {
    x[i] = v.x;
    y[i] = v.y;
    z[i] = v.z;
  }
};

}  // namespace ALHAZEN_CORE

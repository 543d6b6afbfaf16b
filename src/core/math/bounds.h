#pragma once

// Axis-aligned boxes.

#include "core/math/scalar.h"
#include "core/math/vec.h"

namespace ALHAZEN_CORE {

template <class Real>
struct Bounds3 {
  Vec3<Real> low = splat(infinity<Real>);
  Vec3<Real> high = splat(-infinity<Real>);

  ALHAZEN_HD constexpr bool is_empty() const { return !(low.x <= high.x && low.y <= high.y && low.z <= high.z); }
  ALHAZEN_HD constexpr void extend(const Vec3<Real>& p) {
    low = min(low, p);
    high = max(high, p);
  }
  ALHAZEN_HD constexpr void extend(const Bounds3& b) {
    low = min(low, b.low);
    high = max(high, b.high);
  }
  ALHAZEN_HD constexpr Vec3<Real> diagonal() const { return high - low; }
  ALHAZEN_HD constexpr Vec3<Real> centre() const { return (low + high) * Real(0.5); }
  /// Half of the surface area; 0 for an empty box.
  ALHAZEN_HD constexpr Real half_area() const {
    if (is_empty()) return 0;
    const Vec3<Real> d = diagonal();
    return d.x * d.y + d.y * d.z + d.z * d.x;
  }
};

}  // namespace ALHAZEN_CORE

#pragma once

// Orthonormal frames: local coordinates with z along the normal.

#include "core/math/field_list.h"
#include "core/math/scalar.h"
#include "core/math/vec.h"

namespace ALHAZEN_CORE {

template <class Real>
struct Frame {
  Vec3<Real> tangent, bitangent, normal;

  using Fields = FieldList<&Frame::tangent, &Frame::bitangent, &Frame::normal>;

  ALHAZEN_HD Vec3<Real> to_local(const Vec3<Real>& v) const {
    return {dot(v, tangent), dot(v, bitangent), dot(v, normal)};
  }
  ALHAZEN_HD Vec3<Real> to_world(const Vec3<Real>& v) const { return tangent * v.x + bitangent * v.y + normal * v.z; }
};

/// A frame about a unit normal without a branch (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Frame<Real> frame_about(const Vec3<Real>& n) {
  const Real sign = std::copysign(Real(1), n.z);
  const Real a = Real(-1) / (sign + n.z);
  const Real b = n.x * n.y * a;
  return {{Real(1) + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

}  // namespace ALHAZEN_CORE

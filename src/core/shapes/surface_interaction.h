#pragma once

// What is known of a surface at a hit.

#include "core/shapes/shape_records.h"

namespace ALHAZEN_CORE {

template <class Real>
struct SurfaceInteraction {
  Vec3<Real> position;
  Vec3<Real> position_error;  ///< bound on the error of each coordinate
  Vec3<Real> normal;          ///< geometric, unit length, on the front of the surface
  Vec3<Real> shading_normal;
  Vec2<Real> uv;
  uint32_t surface;
  Real time;
  PrimitiveId primitive{};  ///< the primitive that was hit, within `instance`
  uint32_t instance = no_instance;
};

/// Partial derivatives of the position with respect to u and v, at the hit.
template <class Real>
struct SurfaceTangents {
  Vec3<Real> dpdu{}, dpdv{};
};

}  // namespace ALHAZEN_CORE

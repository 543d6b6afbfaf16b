#pragma once

// The point at which a texture is evaluated.

#include "core/shapes/interaction.h"

namespace ALHAZEN_CORE {

template <class Real>
struct TexturePoint {
  Vec3<Real> position;  ///< world space
  Vec2<Real> uv;
  /// Geometric, unit length, on either side. Zero if unknown; images are then evaluated in full detail.
  Vec3<Real> normal{};
  /// Gives access to vertex attributes other than uv; no primitive if there are none.
  Hit<Real> hit{Real(0), Real(0), Real(0), {}};
  Real time = 0;  ///< of the ray, for moving instances
};

template <class Real>
ALHAZEN_HD ALHAZEN_HOT TexturePoint<Real> texture_point(const SurfaceInteraction<Real>& si, const Hit<Real>& hit) {
  return {si.position, si.uv, si.normal, hit, si.time};
}

}  // namespace ALHAZEN_CORE

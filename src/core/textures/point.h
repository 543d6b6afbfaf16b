#pragma once

// Where a texture is looked up.

#include "core/shapes/interaction.h"

namespace ALHAZEN_CORE {

template <class Real>
struct TexturePoint {
  Vec3<Real> position;  ///< world space
  Vec2<Real> uv;
  /// Geometric, unit length, on either side. Zero: unknown; pictures are looked up in full detail then.
  Vec3<Real> normal{};
  /// For what the mesh has at its vertices beside uv. Without a primitive: nothing.
  Hit<Real> hit{Real(0), Real(0), Real(0), {}};
  Real time = 0;  ///< of the ray, for instances that move
};

template <class Real>
ALHAZEN_HD ALHAZEN_HOT TexturePoint<Real> texture_point(const SurfaceInteraction<Real>& si, const Hit<Real>& hit) {
  return {si.position, si.uv, si.normal, hit, si.time};
}

}  // namespace ALHAZEN_CORE

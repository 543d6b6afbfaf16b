#pragma once

// The point at which a texture is evaluated.

#include "core/shapes/interaction.h"

namespace ALHAZEN_CORE {

/// What several textures look up at one point, kept for those that follow: materials take channels of the same image.
/// A negative number is not known yet.
template <class Real>
struct KnownOfPoint {
  Real footprint = -1;                  ///< pixel_footprint
  Real uv_density[2] = {-1, -1};        ///< of either uv set
  uint32_t image = ~0u, mapping = ~0u;  ///< of the last image that was looked up
  Vec3<Real> value{};                   ///< what was found there
};

template <class Real>
struct TexturePoint {
  Vec3<Real> position;  ///< world space
  Vec2<Real> uv;
  /// Geometric, unit length, on either side. Zero if unknown; images are then evaluated in full detail.
  Vec3<Real> normal{};
  /// Gives access to vertex attributes other than uv; no primitive if there are none.
  Hit<Real> hit{Real(0), Real(0), Real(0), {}};
  Real time = 0;  ///< of the ray, for moving instances
  /// Of this point: a copy that is moved elsewhere starts with nothing known.
  mutable KnownOfPoint<Real> known{};
};

template <class Real>
ALHAZEN_HD ALHAZEN_HOT TexturePoint<Real> texture_point(const SurfaceInteraction<Real>& si, const Hit<Real>& hit) {
  return {si.position, si.uv, si.normal, hit, si.time};
}

}  // namespace ALHAZEN_CORE

#pragma once

// Maps points on surfaces to the (s, t) of a texture, and a pixel's footprint to an area of (s, t).

#include "core/math/frame.h"
#include "core/shapes/attributes.h"
#include "core/textures/point.h"

namespace ALHAZEN_CORE {

template <class Real>
ALHAZEN_HD Vec2<Real> map_uv(const TextureMapping<Real>& m, const Vec2<Real>& uv) {
  const auto row = [&](int i) { return m.st_of_uv[i][0] * uv.x + m.st_of_uv[i][1] * uv.y + m.st_of_uv[i][2]; };
  return {row(0), row(1)};
}

template <class Real>
ALHAZEN_HD Vec3<Real> map_solid(const TextureMapping<Real>& m, const Vec3<Real>& p) {
  const auto row = [&](int i) {
    const Real* r = m.texture_from_world[i];
    return r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3];
  };
  return {row(0), row(1), row(2)};
}

/// The mappings that depend on the position alone, as defined by pbrt-v4.
template <class Real>
ALHAZEN_HD Vec2<Real> map_position(const TextureMapping<Real>& m, const Vec3<Real>& position) {
  const Vec3<Real> p = map_solid(m, position);
  switch (m.kind) {
    case TextureMappingKind::spherical: {
      const Real phi = std::atan2(p.y, p.x) * (Real(0.5) * inv_pi<Real>);
      return {std::atan2(std::sqrt(p.x * p.x + p.y * p.y), p.z) * inv_pi<Real>, phi < 0 ? phi + 1 : phi};
    }
    case TextureMappingKind::cylindrical:
      return {Real(0.5) + std::atan2(p.y, p.x) * (Real(0.5) * inv_pi<Real>), p.z};
    default:
      return {p.x, p.y};
  }
}

template <class Real>
ALHAZEN_HD Vec2<Real> map_texture(const SceneView<Real>& scene, const TextureMapping<Real>& m,
                                  const TexturePoint<Real>& at) {
  if (m.kind != TextureMappingKind::uv) return map_position(m, at.position);
  return map_uv(m, m.uv_set == 0 ? at.uv : second_uv(scene, at.hit, at.uv));
}

/// Area of (s, t) per area of the surface; 0 if unknown.
template <class Real>
ALHAZEN_HD Real density_of_uv(const SceneView<Real>& scene, const TextureMapping<Real>& m,
                              const TexturePoint<Real>& at) {
  const Real determinant = std::abs(m.st_of_uv[0][0] * m.st_of_uv[1][1] - m.st_of_uv[0][1] * m.st_of_uv[1][0]);
  Real& density = at.known.uv_density[m.uv_set];
  if (density < 0) density = uv_density(scene, at.hit, at.time, at.normal, m.uv_set);
  return determinant * density;
}

/// The same for the other mappings, by differences over a square of area `footprint`.
template <class Real>
ALHAZEN_HD Real density_of_position(const TextureMapping<Real>& m, const TexturePoint<Real>& at, Real footprint) {
  const Frame<Real> frame = frame_about(at.normal);
  const Real side = std::sqrt(footprint);
  const Vec2<Real> st = map_position(m, at.position);
  const auto step = [&](const Vec3<Real>& along) {
    Vec2<Real> d = map_position(m, at.position + along * side);
    d = {d.x - st.x, d.y - st.y};
    // The difference is taken across the seam of the angle.
    if (m.kind == TextureMappingKind::cylindrical) d.x -= d.x > Real(0.5) ? 1 : d.x < Real(-0.5) ? -1 : 0;
    if (m.kind == TextureMappingKind::spherical) d.y -= d.y > Real(0.5) ? 1 : d.y < Real(-0.5) ? -1 : 0;
    return d;
  };
  const Vec2<Real> a = step(frame.tangent), b = step(frame.bitangent);
  return std::abs(a.x * b.y - a.y * b.x) / footprint;
}

}  // namespace ALHAZEN_CORE

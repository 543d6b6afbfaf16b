#pragma once

// Perturbation of the shading frame by normal maps and bump maps, and its rotation for anisotropy.

#include "core/materials/texture_evaluator.h"
#include "core/shapes/tangents.h"

namespace ALHAZEN_CORE {

/// Returns the normal of a normal map in world space; `frame` is the tangent space.
template <class Real>
ALHAZEN_HD Vec3<Real> mapped_normal(const SceneView<Real>& scene, TextureRange map, Real scale,
                                    const TexturePoint<Real>& at, const Frame<Real>& frame) {
  const Vec3<Real> encoded = evaluate_texture(scene, map, at) * Real(2) - splat(Real(1));
  const Vec3<Real> local{encoded.x * scale, encoded.y * scale, max(encoded.z, Real(1e-3))};
  return normalize(frame.to_world(local));
}

/// Returns the perturbed normal `bent`, turned towards the geometric normal as little as needed for the mirror
/// direction of `wo` to stay above the surface: reflections into the surface would be black.
template <class Real>
ALHAZEN_HD Vec3<Real> reflecting_normal(const Vec3<Real>& bent, const Vec3<Real>& geometric, const Vec3<Real>& wo) {
  const Real side = dot(wo, geometric) < 0 ? Real(-1) : Real(1);
  const Real seen = side * dot(wo, geometric);
  const Real least = seen * Real(0.9) < Real(0.01) ? seen * Real(0.9) : Real(0.01);
  const auto reflects_outwards = [&](const Vec3<Real>& n) {
    return side * (2 * dot(n, wo) * dot(n, geometric) - dot(wo, geometric)) >= least;
  };
  if (reflects_outwards(bent)) return bent;
  Real inside = 0, outside = 1;
  for (int i = 0; i < 8; ++i) {
    const Real middle = (inside + outside) * Real(0.5);
    (reflects_outwards(normalize(lerp(bent, geometric, middle))) ? outside : inside) = middle;
  }
  return normalize(lerp(bent, geometric, outside));
}

/// Returns the normal of the surface displaced along `normal` (Blinn 1978, "Simulation of Wrinkled Surfaces").
template <class Real>
ALHAZEN_HD Vec3<Real> bumped_normal(const SceneView<Real>& scene, TextureRange displacement,
                                    const TexturePoint<Real>& at, const SurfaceTangents<Real>& tangents,
                                    const Vec3<Real>& normal) {
  constexpr Real step = Real(5e-4);
  const Real here = evaluate_texture(scene, displacement, at).x;
  TexturePoint<Real> along_u = at, along_v = at;
  along_u.known = along_v.known = {};
  along_u.uv.x += step;
  along_u.position += tangents.dpdu * step;
  along_v.uv.y += step;
  along_v.position += tangents.dpdv * step;
  const Real du = (evaluate_texture(scene, displacement, along_u).x - here) / step;
  const Real dv = (evaluate_texture(scene, displacement, along_v).x - here) / step;
  const Vec3<Real> n = cross(tangents.dpdu + normal * du, tangents.dpdv + normal * dv);
  if (!(length_squared(n) > 0) || !is_finite(n)) return normal;
  return normalize(face_forward(n, normal));
}

template <class Real>
ALHAZEN_HD Frame<Real> turned(const Frame<Real>& frame, Real cosine, Real sine) {
  return {frame.tangent * cosine + frame.bitangent * sine, frame.bitangent * cosine - frame.tangent * sine,
          frame.normal};
}

/// Returns the shading frame, whose normal consistent_shading_normal makes consistent with `wo`. The perturbed normal
/// is stored in `si`; `coat_normal` receives the normal of the clearcoat in world space.
template <class Real>
ALHAZEN_HD ALHAZEN_COLD Frame<Real> detailed_frame(const SceneView<Real>& scene, const MaterialRecord<Real>& material,
                                                   const Hit<Real>& hit, const TexturePoint<Real>& at,
                                                   const Vec3<Real>& wo, SurfaceInteraction<Real>& si,
                                                   Vec3<Real>& coat_normal) {
  const SurfaceTangents<Real> tangents = surface_tangents(scene, hit, si);
  const bool has_tangents = length_squared(tangents.dpdu) > 0;
  const bool is_principled = material.kind == MaterialKind::principled;
  coat_normal = consistent_shading_normal(si, wo);
  const PrincipledRecord<Real>& principled = material.principled;
  if (is_principled && has_tangents && principled.clearcoat_normal_map.count > 0) {
    SurfaceInteraction<Real> coat = si;
    coat.shading_normal = mapped_normal(scene, principled.clearcoat_normal_map, principled.clearcoat_normal_scale, at,
                                        frame_along(si.shading_normal, tangents));
    coat.shading_normal = reflecting_normal(coat.shading_normal, si.normal, wo);
    coat_normal = consistent_shading_normal(coat, wo);
  }
  if (has_tangents && material.normal_map.count > 0)
    si.shading_normal =
        mapped_normal(scene, material.normal_map, material.normal_scale, at, frame_along(si.shading_normal, tangents));
  if (has_tangents && material.displacement.count > 0)
    si.shading_normal = bumped_normal(scene, material.displacement, at, tangents, si.shading_normal);
  if (has_tangents && (material.normal_map.count > 0 || material.displacement.count > 0))
    si.shading_normal = reflecting_normal(si.shading_normal, si.normal, wo);
  Frame<Real> frame = frame_along(consistent_shading_normal(si, wo), tangents);
  if (!is_principled) return frame;
  if (principled.anisotropy_direction.count > 0) {
    const Vec3<Real> d = evaluate_texture(scene, principled.anisotropy_direction, at) * Real(2) - splat(Real(1));
    const Real size = std::sqrt(d.x * d.x + d.y * d.y);
    if (size > 0) frame = turned(frame, d.x / size, d.y / size);
  }
  return turned(frame, principled.rotation_cosine, principled.rotation_sine);
}

}  // namespace ALHAZEN_CORE

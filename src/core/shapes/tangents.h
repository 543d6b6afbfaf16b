#pragma once

// Tangents of surfaces, for normal maps, bump maps and anisotropic materials.

#include "core/shapes/attributes.h"

namespace ALHAZEN_CORE {

template <class Real>
ALHAZEN_HD SurfaceTangents<Real> triangle_tangents(const SceneView<Real>& scene, const TriangleRecord& triangle) {
  const SurfaceRecord& surface = scene.surfaces[triangle.surface];
  const uint32_t* v = triangle.vertex;
  const Vec3<Real> e1 = scene.positions[v[1]] - scene.positions[v[0]];
  const Vec3<Real> e2 = scene.positions[v[2]] - scene.positions[v[0]];
  const Vec2<Real> uv0 = vertex_uv(scene, surface, v, 0);
  const Vec2<Real> uv1 = vertex_uv(scene, surface, v, 1);
  const Vec2<Real> uv2 = vertex_uv(scene, surface, v, 2);
  const Real du1 = uv1.x - uv0.x, dv1 = uv1.y - uv0.y, du2 = uv2.x - uv0.x, dv2 = uv2.y - uv0.y;
  const Real determinant = difference_of_products(du1, dv2, dv1, du2);
  if (!(std::abs(determinant) > Real(1e-20))) return {};
  const Real scale = 1 / determinant;
  return {(e1 * dv2 - e2 * dv1) * scale, (e2 * du1 - e1 * du2) * scale};
}

template <class Real>
ALHAZEN_HD bool swaps_handedness(const Real (&m)[3][4]) {
  const auto column = [&](int j) { return Vec3<Real>{m[0][j], m[1][j], m[2][j]}; };
  return dot(cross(column(0), column(1)), column(2)) < 0;
}

/// Returns the tangents stored in the mesh, whose lengths have no meaning, or else those of its uvs. They are in world
/// space at the time of the ray.
template <class Real>
ALHAZEN_HD SurfaceTangents<Real> tangents_of(const SceneView<Real>& scene, const TriangleRecord& triangle,
                                             const Hit<Real>& hit, const SurfaceInteraction<Real>& si) {
  MeshTangent<Real> mesh = mesh_tangent(scene, hit);
  SurfaceTangents<Real> own;
  if (mesh.handedness == 0) own = triangle_tangents(scene, triangle);
  if (hit.instance != no_instance) {
    const InstanceRecord<Real> instance = instance_at(scene, hit.instance, si.time);
    const auto& world = instance.world_from_object;
    own = {transform_direction(world, own.dpdu), transform_direction(world, own.dpdv)};
    mesh.direction = transform_direction(world, mesh.direction);
    // Both a mirroring transform and a reversed normal swap the handedness of normal, tangent and bitangent.
    if (swaps_handedness(world) != (instance.flip_normal != 0)) mesh.handedness = -mesh.handedness;
  }
  if (mesh.handedness == 0) return own;
  return {mesh.direction, cross(si.shading_normal, mesh.direction) * mesh.handedness};
}

/// Returns the tangents at the hit, or zero if the uvs do not define them.
template <class Real>
ALHAZEN_HD SurfaceTangents<Real> surface_tangents(const SceneView<Real>& scene, const Hit<Real>& hit,
                                                  const SurfaceInteraction<Real>& si) {
  return visit_primitive(scene, hit.primitive, [&](const auto& record) { return tangents_of(scene, record, hit, si); });
}

/// Returns a frame about `normal` whose tangent is dpdu made orthogonal to it, with the bitangent on the side of dpdv.
template <class Real>
ALHAZEN_HD Frame<Real> frame_along(const Vec3<Real>& normal, const SurfaceTangents<Real>& tangents) {
  const Vec3<Real> t = tangents.dpdu - normal * dot(normal, tangents.dpdu);
  const Real size = length(t);
  if (!(size > 0) || !is_finite(t)) return frame_about(normal);
  const Vec3<Real> tangent = t * (1 / size);
  const Vec3<Real> bitangent = cross(normal, tangent);
  return {tangent, dot(bitangent, tangents.dpdv) < 0 ? -bitangent : bitangent, normal};
}

}  // namespace ALHAZEN_CORE

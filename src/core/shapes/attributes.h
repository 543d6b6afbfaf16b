#pragma once

// Looks up optional vertex attributes of meshes: a second uv set, colours and tangents.

#include "core/scene_view.h"
#include "core/shapes/interaction.h"

namespace ALHAZEN_CORE {

/// Returns the attributes of the mesh that was hit, or null if it has none or the hit is not on a mesh.
template <class Real>
ALHAZEN_HD const AttributesRecord* attributes_of(const SceneView<Real>& scene, const Hit<Real>& hit) {
  if (hit.primitive.is_none() || hit.primitive.kind() != PrimitiveKind::triangle) return nullptr;
  const uint32_t index = scene.surfaces[scene.triangles[hit.primitive.index()].surface].attributes;
  return index == no_offset ? nullptr : scene.vertex_attributes + index;
}

/// Returns the second uv at the hit, or `uv` if there is no second set.
template <class Real>
ALHAZEN_HD Vec2<Real> second_uv(const SceneView<Real>& scene, const Hit<Real>& hit, const Vec2<Real>& uv) {
  const AttributesRecord* attributes = attributes_of(scene, hit);
  if (!attributes || attributes->second_uv_offset == no_offset) return uv;
  const uint32_t* v = scene.triangles[hit.primitive.index()].vertex;
  const auto at = [&](int i) { return scene.uvs[v[i] + attributes->second_uv_offset]; };
  const Vec2<Real> uv0 = at(0), uv1 = at(1), uv2 = at(2);
  const Real b0 = 1 - hit.b1 - hit.b2;
  return {uv0.x * b0 + uv1.x * hit.b1 + uv2.x * hit.b2, uv0.y * b0 + uv1.y * hit.b1 + uv2.y * hit.b2};
}

template <class Real>
struct ColourAndAlpha {
  Vec3<Real> rgb = splat(Real(1));
  Real alpha = 1;
};

/// Returns the interpolated vertex colour, or opaque white if the mesh has no colours.
template <class Real>
ALHAZEN_HD ColourAndAlpha<Real> mesh_colour(const SceneView<Real>& scene, const Hit<Real>& hit) {
  const AttributesRecord* attributes = attributes_of(scene, hit);
  if (!attributes || attributes->colour_offset == no_offset) return {};
  const uint32_t* v = scene.triangles[hit.primitive.index()].vertex;
  const Real weights[3] = {1 - hit.b1 - hit.b2, hit.b1, hit.b2};
  ColourAndAlpha<Real> sum{{}, 0};
  for (int i = 0; i < 3; ++i) {
    const VertexColour& c = scene.vertex_colours[v[i] + attributes->colour_offset];
    sum.rgb += Vec3<Real>{static_cast<Real>(c.red), static_cast<Real>(c.green), static_cast<Real>(c.blue)} * weights[i];
    sum.alpha += static_cast<Real>(c.alpha) * weights[i];
  }
  return sum;
}

/// Transforms a direction from the space of the mesh's positions to world space at `time`.
template <class Real>
ALHAZEN_HD Vec3<Real> direction_in_world(const SceneView<Real>& scene, const Hit<Real>& hit, Real time,
                                         const Vec3<Real>& v) {
  if (hit.instance == no_instance) return v;
  const InstanceRecord<Real>& instance = scene.instances[hit.instance];
  if (instance.motion == no_motion) return transform_direction(instance.world_from_object, v);
  return transform_direction(instance_at(scene, hit.instance, time).world_from_object, v);
}

template <class Real>
struct MeshTangent {
  Vec3<Real> direction{};  ///< not of unit length
  Real handedness = 0;     ///< of front normal, tangent, bitangent: 1 or -1; 0 if the mesh has no tangents
};

/// Interpolates the tangent stored in the mesh, in the space of its positions.
template <class Real>
ALHAZEN_HD MeshTangent<Real> mesh_tangent(const SceneView<Real>& scene, const Hit<Real>& hit) {
  const AttributesRecord* attributes = attributes_of(scene, hit);
  if (!attributes || attributes->tangent_offset == no_offset) return {};
  const uint32_t* v = scene.triangles[hit.primitive.index()].vertex;
  const Real weights[3] = {1 - hit.b1 - hit.b2, hit.b1, hit.b2};
  MeshTangent<Real> tangent;
  for (int i = 0; i < 3; ++i) {
    const VertexTangent& t = scene.vertex_tangents[v[i] + attributes->tangent_offset];
    tangent.direction +=
        Vec3<Real>{static_cast<Real>(t.x), static_cast<Real>(t.y), static_cast<Real>(t.z)} * weights[i];
    // All vertices of a triangle have the same handedness.
    if (i == 0) tangent.handedness = static_cast<Real>(t.handedness);
  }
  return tangent;
}

template <class Real>
ALHAZEN_HD Real uv_density_of(const SceneView<Real>& scene, const TriangleRecord& triangle, const Hit<Real>& hit,
                              Real time, const Vec3<Real>&, uint32_t uv_set) {
  const SurfaceRecord& surface = scene.surfaces[triangle.surface];
  const uint32_t* v = triangle.vertex;
  Vec2<Real> uv[3];
  const AttributesRecord* attributes = uv_set == 0 ? nullptr : attributes_of(scene, hit);
  const bool has_second = attributes && attributes->second_uv_offset != no_offset;
  for (int i = 0; i < 3; ++i)
    uv[i] = has_second ? scene.uvs[v[i] + attributes->second_uv_offset] : vertex_uv(scene, surface, v, i);
  const Real twice_uv_area =
      std::abs((uv[1].x - uv[0].x) * (uv[2].y - uv[0].y) - (uv[1].y - uv[0].y) * (uv[2].x - uv[0].x));
  const Vec3<Real> p0 = scene.positions[v[0]];
  const Vec3<Real> e1 = direction_in_world(scene, hit, time, scene.positions[v[1]] - p0);
  const Vec3<Real> e2 = direction_in_world(scene, hit, time, scene.positions[v[2]] - p0);
  return twice_uv_area / length(cross(e1, e2));
}

/// Returns the area in uv set `uv_set` per surface area in world space at `time`, or 0 if it is unknown.
template <class Real>
ALHAZEN_HD Real uv_density(const SceneView<Real>& scene, const Hit<Real>& hit, Real time, const Vec3<Real>& normal,
                           uint32_t uv_set) {
  if (hit.primitive.is_none()) return 0;
  return visit_primitive(scene, hit.primitive,
                         [&](const auto& record) { return uv_density_of(scene, record, hit, time, normal, uv_set); });
}

}  // namespace ALHAZEN_CORE

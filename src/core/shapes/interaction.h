#pragma once

// From a hit to the point on the surface: position with a bound on its error, normals, uv.

#include "core/scene_view.h"
#include "core/shapes/instance.h"
#include "core/shapes/primitives.h"

namespace ALHAZEN_CORE {

template <class Real>
struct SurfaceInteraction {
  Vec3<Real> position;
  Vec3<Real> position_error;  ///< bound on the error of each coordinate
  Vec3<Real> normal;          ///< geometric, unit length, on the side that the surface calls its front
  Vec3<Real> shading_normal;
  Vec2<Real> uv;
  uint32_t surface;
  Real time;
  PrimitiveId primitive{};  ///< that was hit, and its instance
  uint32_t instance = no_instance;
};

/// Asks for the record of what was met, before anything of it is read. For CPUs.
template <class Real>
ALHAZEN_INLINE void prefetch_primitive(const SceneView<Real>& scene, PrimitiveId primitive) {
  visit_primitive(scene, primitive, [](const auto& record) ALHAZEN_INLINE_LAMBDA { __builtin_prefetch(&record); });
}

/// Asks for what the record refers to.
template <class Real>
ALHAZEN_INLINE void prefetch_vertices(const SceneView<Real>& scene, PrimitiveId primitive) {
  if (primitive.kind() != PrimitiveKind::triangle) return;
  const TriangleRecord& triangle = scene.triangles[primitive.index()];
  const uint32_t normal_offset = scene.surfaces[triangle.surface].normal_offset;
  for (const uint32_t v : triangle.vertex) {
    __builtin_prefetch(scene.positions + v);
    if (normal_offset != no_offset) __builtin_prefetch(scene.normals + v + normal_offset);
  }
}

/// Geometric normal of a triangle by its winding, not of unit length.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec3<Real> triangle_cross(const SceneView<Real>& scene, const TriangleRecord& triangle) {
  const Vec3<Real> p0 = scene.positions[triangle.vertex[0]];
  return cross(scene.positions[triangle.vertex[1]] - p0, scene.positions[triangle.vertex[2]] - p0);
}

template <class Real>
ALHAZEN_HD const Vec3<Real>& vertex_normal(const SceneView<Real>& scene, const SurfaceRecord& surface,
                                           uint32_t vertex) {
  return scene.normals[vertex + surface.normal_offset];
}

/// Where the mesh says that the front of a triangle is, by the sum of its normals there; zero: the winding says it.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec3<Real> mesh_outward(const SceneView<Real>& scene, const SurfaceRecord& surface,
                                               const uint32_t vertex[3]) {
  if (surface.normal_offset == no_offset) return {};
  return vertex_normal(scene, surface, vertex[0]) + vertex_normal(scene, surface, vertex[1]) +
         vertex_normal(scene, surface, vertex[2]);
}

/// uv of a corner; without uvs (0, 0), (1, 0), (1, 1) as pbrt has it.
template <class Real>
ALHAZEN_HD Vec2<Real> vertex_uv(const SceneView<Real>& scene, const SurfaceRecord& surface, const uint32_t vertex[3],
                                int corner) {
  if (surface.uv_offset == no_offset) return {corner > 0 ? Real(1) : Real(0), corner > 1 ? Real(1) : Real(0)};
  return scene.uvs[vertex[corner] + surface.uv_offset];
}

/// Unit geometric normal on the front of a triangle: towards `outward`, as mesh_outward has it, and flipped where the
/// surface says so. `winding` is its triangle_cross.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec3<Real> front_normal(const Vec3<Real>& winding, const Vec3<Real>& outward,
                                               uint32_t flip_normal) {
  return face_forward(normalize(winding), outward) * (flip_normal ? Real(-1) : Real(1));
}

template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec3<Real> triangle_front_normal(const SceneView<Real>& scene, const TriangleRecord& triangle) {
  const SurfaceRecord& surface = scene.surfaces[triangle.surface];
  return front_normal(triangle_cross(scene, triangle), mesh_outward(scene, surface, triangle.vertex),
                      surface.flip_normal);
}

/// The corners of a triangle, and what its mesh has at them.
template <class Real>
struct TriangleCorners {
  Vec3<Real> position[3];
  Vec3<Real> normal[3];  ///< where there are any
  uint32_t has_normals, flip_normal;
};

template <class Real>
ALHAZEN_HD ALHAZEN_HOT TriangleCorners<Real> triangle_corners(const SceneView<Real>& scene,
                                                              const TriangleRecord& triangle) {
  const SurfaceRecord& surface = scene.surfaces[triangle.surface];
  TriangleCorners<Real> corners;
  for (int i = 0; i < 3; ++i) corners.position[i] = scene.positions[triangle.vertex[i]];
  corners.has_normals = surface.normal_offset != no_offset;
  if (corners.has_normals)
    for (int i = 0; i < 3; ++i) corners.normal[i] = vertex_normal(scene, surface, triangle.vertex[i]);
  corners.flip_normal = surface.flip_normal;
  return corners;
}

/// How far rays start from the edges of the triangle that they leave, in units of the bound on the error of the point.
/// Where two triangles of a closed mesh join at an angle, the offset along the normal of one (offset_origin) and
/// rounding must not take the origin through the other: at this distance they do not, unless the angle between them is
/// below a dozen degrees.
template <class Real>
inline constexpr Real edge_clearance = 16;

/// Whether the point with weights b1 and b2 of corners 1 and 2 may be closer to an edge than that; `error` bounds that
/// of its coordinates. Without a root or a division, since every hit asks.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT bool is_near_edge(const Vec3<Real> (&p)[3], Real b1, Real b2, const Vec3<Real>& error) {
  const Real b0 = 1 - b1 - b2;
  const Vec3<Real> e1 = p[2] - p[0], e2 = p[1] - p[0];
  const Real twice_area_squared = length_squared(cross(e2, e1));
  const Real clearance_squared = sqr(edge_clearance<Real> * max_component(error));
  const auto is_near = [&](const Vec3<Real>& edge, Real b) -> int {
    return b * b * twice_area_squared < clearance_squared * length_squared(edge);
  };
  return (is_near(p[2] - p[1], b0) | is_near(e1, b1) | is_near(e2, b2)) != 0;
}

/// What brings the point away from the edges that it is too close to, within the plane. Of triangles too small for that
/// clearance, a third of the height counts.
template <class Real>
ALHAZEN_HD ALHAZEN_RARE Vec3<Real> away_from_edges(const Vec3<Real> (&p)[3], Real b1, Real b2,
                                                   const Vec3<Real>& error) {
  const Real clearance = edge_clearance<Real> * max_component(error);
  const Vec3<Real> e0 = p[2] - p[1], e1 = p[0] - p[2], e2 = p[1] - p[0];
  const Vec3<Real> winding = cross(e1, e2);  // as is_near_edge has it: of needles another may be 0
  const Real twice_area = length(winding);
  if (!(twice_area > 0)) return {};
  // What the distance from an edge lacks, in units of the edge's length.
  const auto lack = [&](const Vec3<Real>& edge, Real b) {
    const Real inverse_length = 1 / length(edge);
    const Real height = twice_area * inverse_length;
    return larger(smaller(clearance, height * Real(1.0 / 3)) - b * height, Real(0)) * inverse_length;
  };
  const Vec3<Real> along = e0 * lack(e0, 1 - b1 - b2) + e1 * lack(e1, b1) + e2 * lack(e2, b2);
  return cross(winding, along) * (1 / twice_area);
}

/// What the rounding of a distance to the triangle adds to the error of a point of it, in all directions: else a ray
/// would start in the very plane of a triangle that lies along axes, and hit others that lie in it.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec3<Real> extent_error(const Vec3<Real> (&p)[3]) {
  return splat(max_component(abs(p[1] - p[0]) + abs(p[2] - p[0])) * rounding_bound<Real>(1));
}

/// The point with weights b1 and b2 of corners 1 and 2, wherever that is in the triangle: position and normals.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT SurfaceInteraction<Real> point_in_plane(const TriangleCorners<Real>& corners, Real b1, Real b2) {
  const Real b0 = 1 - b1 - b2;
  const Vec3<Real>(&p)[3] = corners.position;
  const Vec3<Real> q0 = p[0] * b0, q1 = p[1] * b1, q2 = p[2] * b2;
  SurfaceInteraction<Real> si;
  si.position = q0 + q1 + q2;
  si.position_error = (abs(q0) + abs(q1) + abs(q2)) * rounding_bound<Real>(7) + extent_error(p);
  Vec3<Real> normal = normalize(cross(p[1] - p[0], p[2] - p[0])), shading_normal = normal;
  if (corners.has_normals) {
    const Vec3<Real>* n = corners.normal;
    normal = face_forward(normal, n[0] + n[1] + n[2]);
    const Vec3<Real> between = n[0] * b0 + n[1] * b1 + n[2] * b2;
    shading_normal = select(length_squared(between) > 0, normalize(between), normal);
  }
  const Real side = corners.flip_normal ? Real(-1) : Real(1);
  si.normal = normal * side;
  si.shading_normal = shading_normal * side;
  return si;
}

/// The same, clear of the edges.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT SurfaceInteraction<Real> point_of_triangle(const TriangleCorners<Real>& corners, Real b1,
                                                                  Real b2) {
  SurfaceInteraction<Real> si = point_in_plane(corners, b1, b2);
  if (ALHAZEN_UNLIKELY(is_near_edge(corners.position, b1, b2, si.position_error)))
    si.position += away_from_edges(corners.position, b1, b2, si.position_error);
  return si;
}

template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec2<Real> triangle_uv(const SceneView<Real>& scene, const TriangleRecord& triangle,
                                              const Hit<Real>& hit) {
  const SurfaceRecord& surface = scene.surfaces[triangle.surface];
  const Real b0 = 1 - hit.b1 - hit.b2;
  const Vec2<Real> uv0 = vertex_uv(scene, surface, triangle.vertex, 0);
  const Vec2<Real> uv1 = vertex_uv(scene, surface, triangle.vertex, 1);
  const Vec2<Real> uv2 = vertex_uv(scene, surface, triangle.vertex, 2);
  return {uv0.x * b0 + uv1.x * hit.b1 + uv2.x * hit.b2, uv0.y * b0 + uv1.y * hit.b1 + uv2.y * hit.b2};
}

template <class Real>
ALHAZEN_HD ALHAZEN_NOINLINE SurfaceInteraction<Real> triangle_interaction(const SceneView<Real>& scene,
                                                                          const Hit<Real>& hit) {
  const TriangleRecord& triangle = scene.triangles[hit.primitive.index()];
  SurfaceInteraction<Real> si = point_of_triangle(triangle_corners(scene, triangle), hit.b1, hit.b2);
  si.uv = triangle_uv(scene, triangle, hit);
  si.surface = triangle.surface;
  return si;
}

/// The hit point is pushed onto the sphere along the radius, so its error depends on centre and radius alone, not on
/// the distance that the ray came.
template <class Real, SphereRecordOf<Real> Record>
ALHAZEN_HD ALHAZEN_HOT void set_interaction(const SceneView<Real>& scene, const Record& record, const Ray<Real>& ray,
                                            const Hit<Real>& hit, SurfaceInteraction<Real>& si) {
  const auto [center, radius] = sphere_at(record, ray.time);
  const Vec3<Real> outward = normalize(ray.origin - center + ray.direction * hit.t);
  const Vec3<Real> from_center = outward * radius;
  si.position = center + from_center;
  si.position_error = (abs(center) + splat(radius)) * rounding_bound<Real>(8);
  si.normal = scene.surfaces[record.surface].flip_normal ? -outward : outward;
  si.shading_normal = si.normal;
  si.uv = {};
  if (record.frame != no_sphere_frame) {
    const SphereFrame<Real>& axes = scene.sphere_frames[record.frame];
    si.uv = sphere_uv(Vec3<Real>{dot(outward, axes.x), dot(outward, axes.y), dot(outward, axes.z)});
  }
  si.surface = record.surface;
}

/// Where a triangle of an object was met, as the instance has it at `time`.
template <class Real>
ALHAZEN_HD ALHAZEN_COLD SurfaceInteraction<Real> instance_interaction(const SceneView<Real>& scene,
                                                                      const Hit<Real>& hit, Real time) {
  const TriangleRecord& triangle = scene.triangles[hit.primitive.index()];
  const TriangleCorners<Real> corners = triangle_corners(scene, triangle);
  const SurfaceInteraction<Real> object = point_in_plane(corners, hit.b1, hit.b2);
  const InstanceRecord<Real> instance = instance_at(scene, hit.instance, time);
  SurfaceInteraction<Real> si;
  si.uv = triangle_uv(scene, triangle, hit);
  si.surface = triangle.surface;
  si.position = transform_point(instance.world_from_object, object.position);
  si.position_error = world_position_error(instance, object.position, object.position_error, si.position);
  Vec3<Real> p[3];
  for (int i = 0; i < 3; ++i) p[i] = transform_point(instance.world_from_object, corners.position[i]);
  if (is_near_edge(p, hit.b1, hit.b2, si.position_error))
    si.position += away_from_edges(p, hit.b1, hit.b2, si.position_error);
  const auto outward = [&](const Vec3<Real>& n) {
    const Vec3<Real> turned = normalize(transform_normal(instance.object_from_world, n));
    return instance.flip_normal ? -turned : turned;
  };
  si.normal = outward(object.normal);
  si.shading_normal = outward(object.shading_normal);
  return si;
}

template <class Real>
ALHAZEN_HD ALHAZEN_HOT void set_interaction(const SceneView<Real>& scene, const TriangleRecord&, const Ray<Real>& ray,
                                            const Hit<Real>& hit, SurfaceInteraction<Real>& si) {
  if (hit.instance == no_instance)
    si = triangle_interaction(scene, hit);
  else
    si = instance_interaction(scene, hit, ray.time);
}

/// Sets `si` in its place: a copy of what has just been written would wait for it.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT void meet_surface(const SceneView<Real>& scene, const Ray<Real>& ray, const Hit<Real>& hit,
                                         SurfaceInteraction<Real>& si) {
  visit_primitive(scene, hit.primitive,
                  [&](const auto& record) ALHAZEN_INLINE_LAMBDA { set_interaction(scene, record, ray, hit, si); });
  si.time = ray.time;
  si.primitive = hit.primitive;
  si.instance = hit.instance;
}

template <class Real>
ALHAZEN_HD ALHAZEN_HOT SurfaceInteraction<Real> surface_interaction(const SceneView<Real>& scene, const Ray<Real>& ray,
                                                                    const Hit<Real>& hit) {
  SurfaceInteraction<Real> si;
  meet_surface(scene, ray, hit, si);
  return si;
}

/// The shading normal, bent as little as needed for `wo` to lie on the same side of it as of the geometric normal.
/// Interpolated normals break that near silhouettes, and black rims come of it.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec3<Real> consistent_shading_normal(const SurfaceInteraction<Real>& si, const Vec3<Real>& wo) {
  const Real side = dot(wo, si.normal) < 0 ? Real(-1) : Real(1);
  const Real seen = side * dot(wo, si.shading_normal);
  constexpr Real least = Real(1e-3);
  return select(seen >= least, si.shading_normal, normalize(si.shading_normal + wo * (side * (least - seen))));
}

}  // namespace ALHAZEN_CORE

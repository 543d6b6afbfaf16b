#pragma once

// Computes the surface interaction at a hit: the position with a bound on its error, normals and uv. Here are those on
// triangles; other shapes have a header of their own.

#include "core/math/field_list.h"
#include "core/scene_view.h"
#include "core/shapes/instance.h"
#include "core/shapes/primitives.h"
#include "core/shapes/surface_interaction.h"

namespace ALHAZEN_CORE {

/// Prefetches the record of the primitive that was hit. For CPUs.
template <class Real>
ALHAZEN_INLINE void prefetch_primitive(const SceneView<Real>& scene, PrimitiveId primitive) {
  visit_primitive(scene, primitive, [](const auto& record) ALHAZEN_INLINE_LAMBDA { __builtin_prefetch(&record); });
}

/// Prefetches the vertices that the record refers to. For CPUs.
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

/// Returns the geometric normal of a triangle from its winding; it is not normalized.
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

/// Returns the sum of the vertex normals of a triangle, which points to its front, or zero if the winding determines
/// the front.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec3<Real> mesh_outward(const SceneView<Real>& scene, const SurfaceRecord& surface,
                                               const uint32_t vertex[3]) {
  if (surface.normal_offset == no_offset) return {};
  return vertex_normal(scene, surface, vertex[0]) + vertex_normal(scene, surface, vertex[1]) +
         vertex_normal(scene, surface, vertex[2]);
}

/// Returns the uv of a corner. Meshes without uvs use (0, 0), (1, 0), (1, 1), as in pbrt.
template <class Real>
ALHAZEN_HD Vec2<Real> vertex_uv(const SceneView<Real>& scene, const SurfaceRecord& surface, const uint32_t vertex[3],
                                int corner) {
  if (surface.uv_offset == no_offset) return {corner > 0 ? Real(1) : Real(0), corner > 1 ? Real(1) : Real(0)};
  return scene.uvs[vertex[corner] + surface.uv_offset];
}

/// Returns the unit geometric normal on the front of a triangle: on the side of `outward` (mesh_outward), and reversed
/// if `flip_normal` is set. `winding` is its triangle_cross.
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

/// The positions and normals at the corners of a triangle.
template <class Real>
struct TriangleCorners {
  Vec3<Real> position[3];
  Vec3<Real> normal[3];  ///< set only if has_normals
  uint32_t has_normals, flip_normal;

  using Fields = FieldList<&TriangleCorners::position, &TriangleCorners::normal, &TriangleCorners::has_normals,
                           &TriangleCorners::flip_normal>;
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

/// Returns the error that the rounding of the distance to the triangle adds to its points, in all directions. Without
/// it, a ray would start exactly in the plane of an axis-aligned triangle and hit other triangles in this plane.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec3<Real> extent_error(const Vec3<Real> (&p)[3]) {
  return splat(max_component(abs(p[1] - p[0]) + abs(p[2] - p[0])) * rounding_bound<Real>(1));
}

/// Minimum distance of ray origins from the edges of the triangle that the ray starts on, in units of the bound on the
/// error of the point. Where two triangles of a closed mesh join at an angle, the offset along the normal of one
/// (offset_origin) and rounding must not move the origin through the other. This distance prevents it, unless the angle
/// between them is below a dozen degrees.
template <class Real>
inline constexpr Real edge_clearance = 16;

/// How far a point in a sharp corner moves at most, in units of its clearance.
template <class Real>
inline constexpr Real max_corner_offset = 1000;

/// Returns whether the point with barycentric coordinates b1 and b2 may be closer to an edge than edge_clearance, where
/// `error` bounds the error of the point. Avoids square roots and divisions, since it runs for every hit.
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

/// Returns the offset within the plane that moves the point away from edges that are too close. The clearance is at
/// most a third of the height of the triangle. In a sharp corner the offsets from both edges cancel each other; there
/// the point moves into the triangle along the edges until it is clear of them for the rounding error at the corner,
/// which is that of the coordinates alone.
template <class Real>
ALHAZEN_HD ALHAZEN_RARE Vec3<Real> away_from_edges(const Vec3<Real> (&p)[3], Real b1, Real b2,
                                                   const Vec3<Real>& error) {
  const Real clearance = edge_clearance<Real> * max_component(error);
  const Vec3<Real> edge[3] = {p[2] - p[1], p[0] - p[2], p[1] - p[0]};
  const Vec3<Real> winding = cross(edge[1], edge[2]);  // as is_near_edge has it: for needles, other edges may give 0
  const Real twice_area = length(winding);
  if (!(twice_area > 0)) return {};
  const Real b[3] = {1 - b1 - b2, b1, b2};
  Real length_of[3], height[3], lack[3];
  for (int i = 0; i < 3; ++i) {
    length_of[i] = length(edge[i]);
    height[i] = twice_area * (1 / length_of[i]);
    lack[i] = max(min(clearance, height[i] * Real(1.0 / 3)) - b[i] * height[i], Real(0));
  }
  const auto push = [&](int i) { return edge[i] * (lack[i] * (1 / length_of[i])); };
  const Vec3<Real> along = push(0) + push(1) + push(2);
  const Vec3<Real> offset = cross(winding, along) * (1 / twice_area);

  const Vec3<Real> coordinates = max(error - extent_error(p), Vec3<Real>{});
  const Real distance_to_corners =
      2 * (b[1] * b[2] * length_of[0] + b[2] * b[0] * length_of[1] + b[0] * b[1] * length_of[2]);  // on average
  // Needles may be narrower than the clearance. Two corners may have to be left.
  const Real longest = max(max(length_of[0], length_of[1]), length_of[2]);
  const Real max_lowest = min(max_corner_offset<Real> * clearance / (2 * longest), Real(1.0 / 3));
  Real lowest[3], above_lowest[3], sum = 0, above = 0;
  bool is_clear = true;
  for (int i = 0; i < 3; ++i) {
    const Vec3<Real> direction = edge[i] * (1 / length_of[i]);
    const Vec3<Real> normal = cross(winding, direction) * (1 / twice_area);
    const Real local = dot(abs(normal), coordinates) + distance_to_corners * rounding_bound<Real>(1);
    lowest[i] = min(edge_clearance<Real> * local / height[i], max_lowest);
    is_clear &= b[i] + dot(direction, along) / height[i] >= lowest[i];
    above_lowest[i] = max(b[i] - lowest[i], Real(0));
    sum += lowest[i];
    above += above_lowest[i];
  }
  if (is_clear) return offset;
  const Real scale = above > 0 ? (1 - sum) / above : Real(0);
  const auto change = [&](int i) { return lowest[i] + above_lowest[i] * scale - b[i]; };
  return edge[2] * change(1) - edge[1] * change(2);
}

/// Returns the position and normals at barycentric coordinates b1 and b2, without clearance from the edges.
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

/// Like point_in_plane, but moves the position away from edges that are too close.
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

/// Returns the interaction on a triangle of an instance, in world space at `time`.
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

/// Computes the surface interaction at a hit in place, since copying data that was just written would stall.
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

/// Returns the shading normal, bent as little as needed for `wo` to be on the same side of it as of the geometric
/// normal. Interpolated normals violate this near silhouettes, which causes black rims.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec3<Real> consistent_shading_normal(const SurfaceInteraction<Real>& si, const Vec3<Real>& wo) {
  const Real side = dot(wo, si.normal) < 0 ? Real(-1) : Real(1);
  const Real seen = side * dot(wo, si.shading_normal);
  constexpr Real least = Real(1e-3);
  return select(seen >= least, si.shading_normal, normalize(si.shading_normal + wo * (side * (least - seen))));
}

}  // namespace ALHAZEN_CORE

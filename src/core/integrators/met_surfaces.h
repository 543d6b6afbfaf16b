#pragma once

// What many rays have met, column by column, with points on triangles worked out side by side: that loop has no
// branches that matter, so that compilers turn it into SIMD instructions.

#include "core/integrators/stages.h"
#include "core/simd/columns.h"

namespace ALHAZEN_CORE {

/// By up to `most` rays, each with a place of its own, which may stay empty.
template <class Real, uint32_t most>
class MetSurfaces {
 public:
  /// Whether the hit is for `meet`: a triangle of the world.
  static bool takes(const Hit<Real>& hit) {
    return hit.primitive.kind() == PrimitiveKind::triangle && hit.instance == no_instance;
  }

  ALHAZEN_INLINE void meet(uint32_t i, const SceneView<Real>& scene, const Ray<Real>& ray, const Hit<Real>& hit) {
    const TriangleCorners<Real> corners = triangle_corners(scene, scene.triangles[hit.primitive.index()]);
    for (int k = 0; k < 3; ++k) corner_[k].set(i, corners.position[k]);
    has_normals_[i] = corners.has_normals;
    flip_normal_[i] = corners.flip_normal;
    if (corners.has_normals) {
      for (int k = 0; k < 3; ++k) corner_normal_[k].set(i, corners.normal[k]);
      any_normals_ = true;
    }
    b1_[i] = hit.b1;
    b2_[i] = hit.b2;
    wo_.set(i, -ray.direction);
    any_ = true;
  }

  /// Works out the triangles among the first `count` places.
  void work_out(uint32_t count) {
    if (any_) any_normals_ ? work_out<true>(whole_rows(count)) : work_out<false>(whole_rows(count));
    any_ = any_normals_ = false;
  }

  /// Of a triangle that has been worked out.
  ALHAZEN_INLINE ShadingPoint<Real> shading_point(uint32_t i, const SceneView<Real>& scene, const Ray<Real>& ray,
                                                  const Hit<Real>& hit) const {
    const TriangleRecord& triangle = scene.triangles[hit.primitive.index()];
    ShadingPoint<Real> point;
    point.si = {
        position_[i],     position_error_[i], normal_[i],    shading_normal_[i], triangle_uv(scene, triangle, hit),
        triangle.surface, ray.time,           hit.primitive, hit.instance};
    set_material(scene, ray, hit, frame(i), point);
    return point;
  }

  /// What `meet` and `work_out` would have left here, but of any surface.
  ALHAZEN_INLINE void set(uint32_t i, const ShadingPoint<Real>& point) {
    position_.set(i, point.si.position);
    position_error_.set(i, point.si.position_error);
    normal_.set(i, point.si.normal);
    wo_.set(i, point.wo);
    set_frame(i, point.bsdf.frame);
  }

  /// A shading point without its material.
  ALHAZEN_INLINE ShadingPoint<Real> bare_point(uint32_t i) const {
    ShadingPoint<Real> point;
    point.si.position = position_[i];
    point.si.position_error = position_error_[i];
    point.si.normal = normal_[i];
    point.si.time = 0;
    point.bsdf.frame = frame(i);
    point.wo = wo_[i];
    return point;
  }
  ALHAZEN_INLINE Vec3<Real> position(uint32_t i) const { return position_[i]; }

 private:
  template <bool with_normals>
  void work_out(uint32_t end) {
    uint32_t any_near_edge = 0;
    ALHAZEN_SIDE_BY_SIDE
    for (uint32_t i = 0; i < end; ++i) {
      TriangleCorners<Real> corners;
      for (int k = 0; k < 3; ++k) corners.position[k] = corner_[k][i];
      for (int k = 0; k < 3 && with_normals; ++k) corners.normal[k] = corner_normal_[k][i];
      corners.has_normals = with_normals ? has_normals_[i] : 0;
      corners.flip_normal = flip_normal_[i];
      const SurfaceInteraction<Real> si = point_in_plane(corners, b1_[i], b2_[i]);
      is_near_edge_[i] = is_near_edge(corners.position, b1_[i], b2_[i], si.position_error);
      any_near_edge |= is_near_edge_[i];
      const Frame<Real> frame = frame_about(consistent_shading_normal(si, wo_[i]));
      position_.set(i, si.position);
      position_error_.set(i, si.position_error);
      normal_.set(i, si.normal);
      shading_normal_.set(i, si.shading_normal);
      set_frame(i, frame);
    }
    for (uint32_t i = 0; i < end && any_near_edge; ++i)
      if (is_near_edge_[i]) clear_edges(i);
  }

  /// What point_of_triangle does beyond point_in_plane.
  ALHAZEN_NOINLINE void clear_edges(uint32_t i) {
    const Vec3<Real> corners[3] = {corner_[0][i], corner_[1][i], corner_[2][i]};
    position_.set(i, position_[i] + away_from_edges(corners, b1_[i], b2_[i], position_error_[i]));
  }

  ALHAZEN_INLINE void set_frame(uint32_t i, const Frame<Real>& frame) {
    tangent_.set(i, frame.tangent);
    bitangent_.set(i, frame.bitangent);
    frame_normal_.set(i, frame.normal);
  }
  ALHAZEN_INLINE Frame<Real> frame(uint32_t i) const { return {tangent_[i], bitangent_[i], frame_normal_[i]}; }

  using Vectors = VectorColumns<Real, most>;
  Vectors corner_[3], corner_normal_[3], wo_;
  Real b1_[most]{}, b2_[most]{};
  uint32_t has_normals_[most]{}, flip_normal_[most]{}, is_near_edge_[most]{};
  Vectors position_, position_error_, normal_, shading_normal_, tangent_, bitangent_, frame_normal_;
  bool any_ = false, any_normals_ = false;
};

}  // namespace ALHAZEN_CORE

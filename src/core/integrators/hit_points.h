#pragma once

// The hit points of many rays in structure-of-arrays form. Points on triangles are computed together in a loop without
// important branches, which compilers turn into SIMD instructions.

#include "core/integrators/stages.h"
#include "core/simd/columns.h"

namespace ALHAZEN_CORE {

/// Hit points of up to `max_count` rays, indexed by ray; entries may be unused.
template <class Real, uint32_t max_count>
class HitPoints {
 public:
  /// Returns whether `add_triangle` accepts the hit: a triangle that is not part of an instance.
  static bool accepts(const Hit<Real>& hit) {
    return hit.primitive.kind() == PrimitiveKind::triangle && hit.instance == no_instance;
  }

  ALHAZEN_INLINE void add_triangle(uint32_t i, const SceneView<Real>& scene, const Ray<Real>& ray,
                                   const Hit<Real>& hit) {
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

  /// Computes the points of the triangles among the first `count` entries.
  void compute(uint32_t count) {
    if (any_) any_normals_ ? compute<true>(whole_rows(count)) : compute<false>(whole_rows(count));
    any_ = any_normals_ = false;
  }

  /// The shading point of a triangle that has been computed.
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

  /// Stores a surface of any kind in the form that `add_triangle` and `compute` produce.
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
  void compute(uint32_t end) {
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

  /// Does what point_of_triangle does beyond point_in_plane.
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

  using Vectors = VectorColumns<Real, max_count>;
  Vectors corner_[3], corner_normal_[3], wo_;
  Real b1_[max_count]{}, b2_[max_count]{};
  uint32_t has_normals_[max_count]{}, flip_normal_[max_count]{}, is_near_edge_[max_count]{};
  Vectors position_, position_error_, normal_, shading_normal_, tangent_, bitangent_, frame_normal_;
  bool any_ = false, any_normals_ = false;
};

}  // namespace ALHAZEN_CORE

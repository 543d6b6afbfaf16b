#pragma once

// The hit points of many rays in structure-of-arrays form. Points on triangles are computed together in a loop without
// important branches, which compilers turn into SIMD instructions.

#include "core/integrators/stages.h"
#include "core/simd/soa.h"

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
    using Corners = TriangleCorners<Real>;
    const Corners corners = triangle_corners(scene, scene.triangles[hit.primitive.index()]);
    corners_.template set_only<&Corners::position, &Corners::has_normals, &Corners::flip_normal>(i, corners);
    if (corners.has_normals) {
      corners_.template set_only<&Corners::normal>(i, corners);
      any_normals_ = true;
    }
    hits_.set(i, hit);
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
    points_.get(i, point.si);
    point.si.uv = triangle_uv(scene, triangle, hit);
    point.si.surface = triangle.surface;
    point.si.time = ray.time;
    point.si.primitive = hit.primitive;
    point.si.instance = hit.instance;
    set_material(scene, ray, hit, frames_[i], point);
    return point;
  }

  /// Stores a surface of any kind in the form that `add_triangle` and `compute` produce.
  ALHAZEN_INLINE void set(uint32_t i, const ShadingPoint<Real>& point) {
    points_.set(i, point.si);
    wo_.set(i, point.wo);
    frames_.set(i, point.bsdf.frame);
  }

  /// A shading point without its material.
  ALHAZEN_INLINE ShadingPoint<Real> bare_point(uint32_t i) const {
    ShadingPoint<Real> point;
    points_.get(i, point.si);
    point.si.time = 0;
    point.bsdf.frame = frames_[i];
    point.wo = wo_[i];
    return point;
  }
  ALHAZEN_INLINE Vec3<Real> position(uint32_t i) const { return points_.template get_only<&Interaction::position>(i); }

 private:
  using Interaction = SurfaceInteraction<Real>;

  template <bool with_normals>
  void compute(uint32_t end) {
    uint32_t any_near_edge = 0;
    ALHAZEN_SIDE_BY_SIDE
    for (uint32_t i = 0; i < end; ++i) {
      TriangleCorners<Real> corners = corners_[i];
      if constexpr (!with_normals) corners.has_normals = 0;
      const Hit<Real> hit = hits_[i];
      const Interaction si = point_in_plane(corners, hit.b1, hit.b2);
      is_near_edge_[i] = is_near_edge(corners.position, hit.b1, hit.b2, si.position_error);
      any_near_edge |= is_near_edge_[i];
      points_.set(i, si);
      frames_.set(i, frame_about(consistent_shading_normal(si, wo_[i])));
    }
    for (uint32_t i = 0; i < end && any_near_edge; ++i)
      if (is_near_edge_[i]) clear_edges(i);
  }

  /// Does what point_of_triangle does beyond point_in_plane.
  ALHAZEN_NOINLINE void clear_edges(uint32_t i) {
    const TriangleCorners<Real> corners = corners_[i];
    const Hit<Real> hit = hits_[i];
    Interaction si;
    points_.get(i, si);
    si.position += away_from_edges(corners.position, hit.b1, hit.b2, si.position_error);
    points_.set(i, si);
  }

  SoA<TriangleCorners<Real>, max_count> corners_;
  SoA<Hit<Real>, max_count, FieldList<&Hit<Real>::b1, &Hit<Real>::b2>> hits_;
  SoA<Vec3<Real>, max_count> wo_;
  uint32_t is_near_edge_[max_count]{};
  SoA<Interaction, max_count,
      FieldList<&Interaction::position, &Interaction::position_error, &Interaction::normal,
                &Interaction::shading_normal>>
      points_;
  SoA<Frame<Real>, max_count> frames_;
  bool any_ = false, any_normals_ = false;
};

}  // namespace ALHAZEN_CORE

#pragma once

// The points that rays hit. Those on triangles of the world are computed together by SIMD, as in renders
// (core/integrators/hit_points.h), all others one by one.

#include "core/shapes/interaction.h"
#include "core/simd/soa.h"
#include "queries/kernels/chunk_tracer.h"

namespace ALHAZEN_CORE {

/// Which numbers of a SurfaceInteraction are read.
struct WantedOfSurface {
  bool position;  ///< or its error
  bool uv;
};

/// The points of some rays of a chunk.
template <class Real>
class SurfacePoints {
 public:
  static constexpr uint32_t capacity = 64;
  static_assert(PreparedRays<Real>::capacity % capacity == 0);

  /// Computes the points that `count` rays from `first` on hit.
  void meet(const SceneView<Real>& scene, const PreparedRays<Real>& rays, const ChunkHits<Real>& hits, uint32_t first,
            uint32_t count, const HitRows& rows, WantedOfSurface wanted) {
    uint32_t others = 0, triangles = 0, normals = 0;
    for (uint32_t i = 0; i < count; ++i) {
      const uint32_t ray = first + i, next = ray + ahead;
      if (next < rays.count && hits.found(next)) prefetch_vertices(scene, hits.hit[next].primitive);
      is_hit_[i] = hits.found(ray);
      if (!is_hit_[i]) continue;
      const Hit<Real>& hit = hits.hit[ray];
      if (hit.primitive.kind() != PrimitiveKind::triangle || hit.instance != no_instance) {
        others_[others++] = i;
        continue;
      }
      const TriangleRecord& triangle = scene.triangles[hit.primitive.index()];
      const SurfaceRecord& surface = scene.surfaces[triangle.surface];
      const bool has_normals = surface.normal_offset != no_offset;
      for (int v = 0; v < 3; ++v) {
        copy(scene.positions[triangle.vertex[v]], i, position_[v]);
        if (has_normals) copy(vertex_normal(scene, surface, triangle.vertex[v]), i, normal_[v]);
      }
      has_normals_[i] = has_normals;
      flip_normal_[i] = surface.flip_normal;
      b1_[i] = hit.b1;
      b2_[i] = hit.b2;
      if (wanted.uv)
        uv_.set(i, surface.uv_offset != no_offset ? triangle_uv(scene, triangle, hit) : corner_uv(rows, hit));
      ++triangles;
      normals |= has_normals;
    }
    if (triangles > 0) {
      if (normals)
        wanted.position ? compute<true, true>(count) : compute<true, false>(count);
      else
        wanted.position ? compute<false, true>(count) : compute<false, false>(count);
    }
    for (uint32_t k = 0; k < others; ++k) {
      const uint32_t i = others_[k];
      Interaction si;
      meet_surface(scene, rays.rays[first + i], hits.hit[first + i], si);
      points_.set(i, si);
      const bool has_corners = hits.hit[first + i].primitive.kind() == PrimitiveKind::triangle &&
                               scene.surfaces[si.surface].uv_offset == no_offset;
      uv_.set(i, has_corners ? corner_uv(rows, hits.hit[first + i]) : si.uv);
    }
  }

  ALHAZEN_INLINE uint32_t is_hit(uint32_t i) const { return is_hit_[i]; }
  /// Without uv, surface, time, primitive and instance.
  ALHAZEN_INLINE SurfaceInteraction<Real> point(uint32_t i) const { return points_[i]; }
  ALHAZEN_INLINE Vec2<Real> uv(uint32_t i) const { return uv_[i]; }

 private:
  using Interaction = SurfaceInteraction<Real>;

  /// The uv in a mesh without: its corners have (0, 0), (1, 0) and (1, 1).
  static ALHAZEN_INLINE Vec2<Real> corner_uv(const HitRows& rows, const Hit<Real>& hit) {
    const Vec2<Real> weights = described_weights(hit, rows.of(hit).turn);
    return {weights.x + weights.y, weights.y};
  }

  /// Hits whose vertices are fetched into the caches before they are read.
  static constexpr uint32_t ahead = 8;

  static ALHAZEN_INLINE void copy(const Vec3<Real>& from, uint32_t i, Real (&to)[3][capacity]) {
    to[0][i] = from.x;
    to[1][i] = from.y;
    to[2][i] = from.z;
  }

  ALHAZEN_INLINE TriangleCorners<Real> corners_of(uint32_t i) const {
    TriangleCorners<Real> corners;
    for (int v = 0; v < 3; ++v) {
      corners.position[v] = {position_[v][0][i], position_[v][1][i], position_[v][2][i]};
      corners.normal[v] = {normal_[v][0][i], normal_[v][1][i], normal_[v][2][i]};
    }
    corners.has_normals = has_normals_[i];
    corners.flip_normal = flip_normal_[i];
    return corners;
  }

  template <bool with_normals, bool with_positions>
  ALHAZEN_NOINLINE void compute(uint32_t count) {
    uint32_t any_near_edge = 0;
    const uint32_t end = whole_rows(count);
    ALHAZEN_SIDE_BY_SIDE
    for (uint32_t i = 0; i < end; ++i) {
      TriangleCorners<Real> corners = corners_of(i);
      if constexpr (!with_normals) corners.has_normals = 0;
      const Interaction si = point_in_plane(corners, b1_[i], b2_[i]);
      if constexpr (with_positions) {
        is_near_edge_[i] = is_near_edge(corners.position, b1_[i], b2_[i], si.position_error);
        any_near_edge |= is_near_edge_[i];
        points_.set(i, si);
      } else {
        points_.template set_only<&Interaction::normal, &Interaction::shading_normal>(i, si);
      }
    }
    for (uint32_t i = 0; i < count && any_near_edge; ++i)
      if (is_near_edge_[i] & is_hit_[i]) clear_edges(i);
  }

  /// Does what point_of_triangle does beyond point_in_plane.
  ALHAZEN_NOINLINE void clear_edges(uint32_t i) {
    const TriangleCorners<Real> corners = corners_of(i);
    Interaction si = points_[i];
    si.position += away_from_edges(corners.position, b1_[i], b2_[i], si.position_error);
    points_.template set_only<&Interaction::position>(i, si);
  }

  // Of triangles: a row per coordinate of a corner, and what TriangleCorners has besides.
  Real position_[3][3][capacity]{}, normal_[3][3][capacity]{};
  uint32_t has_normals_[capacity]{}, flip_normal_[capacity]{};
  Real b1_[capacity]{}, b2_[capacity]{};
  uint32_t is_near_edge_[capacity]{}, is_hit_[capacity]{};
  SoA<Interaction, capacity,
      FieldList<&Interaction::position, &Interaction::position_error, &Interaction::normal,
                &Interaction::shading_normal>>
      points_;
  SoA<Vec2<Real>, capacity> uv_;
  uint32_t others_[capacity];
};

}  // namespace ALHAZEN_CORE

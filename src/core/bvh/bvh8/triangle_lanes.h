#pragma once

// The test of core/shapes/triangle.h on SIMD lanes. It performs the same operations in the same order, so that hits are
// bitwise identical for every instruction set. A lane pairs a ray with a triangle: one ray with many triangles
// (blocks.h), or many rays with one triangle (packets.h).

#include <bit>

#include "core/bvh/bvh2/traversal.h"
#include "core/shapes/triangle.h"
#include "core/simd/lanes.h"

namespace ALHAZEN_CORE {

/// Vertices in the sheared spaces of the rays. z is not yet multiplied by shear[2].
template <class V>
struct ShearedLanes {
  V x, y, z;

  ShearedLanes() = default;
  /// `p`, `origin` and `shear` are given along the rays' axes kx, ky, kz.
  ALHAZEN_INLINE ShearedLanes(const V (&p)[3], const V (&origin)[3], const V (&shear)[3]) {
    z = p[2] - origin[2];
    x = p[0] - origin[0] - shear[0] * z;
    y = p[1] - origin[1] - shear[1] * z;
  }
};

/// Intersects rays with triangles, watertight (Woop, Benthin, Wald 2013).
template <class V>
struct TriangleLanes {
  V e[3];  ///< edge functions
  V inverse, t;
  uint32_t inside = 0;  ///< one bit per lane; if none is set, `inverse` and `t` are not computed

  /// `vertex(v, k)` returns coordinate k of vertex v, where k = 0, 1, 2 denotes the ray's axes kx, ky, kz.
  template <class Vertex>
  ALHAZEN_INLINE TriangleLanes(const Vertex& vertex, const V (&origin)[3], const V (&shear)[3],
                               uint32_t checks_narrow_triangles)
      : TriangleLanes(sheared(vertex, 0, origin, shear), sheared(vertex, 1, origin, shear),
                      sheared(vertex, 2, origin, shear), shear[2], checks_narrow_triangles) {}

  ALHAZEN_INLINE TriangleLanes(const ShearedLanes<V>& a, const ShearedLanes<V>& b, const ShearedLanes<V>& c,
                               const V& scale, uint32_t checks_narrow_triangles) {
    const V zero = V::all(0);
    e[0] = b.x * c.y - b.y * c.x;
    e[1] = c.x * a.y - c.y * a.x;
    e[2] = a.x * b.y - a.y * b.x;
    inside = less_equal(zero, min(min(e[0], e[1]), e[2])) | less_equal(max(max(e[0], e[1]), e[2]), zero);
    if (inside == 0) return;
    if (ALHAZEN_UNLIKELY(checks_narrow_triangles != 0)) recompute_displaced(a, b, c);
    // If the sum is 0, t is infinite or NaN and the hit is rejected.
    inverse = V::all(1) / (e[0] + e[1] + e[2]);
    t = (e[0] * (a.z * scale) + e[1] * (b.z * scale) + e[2] * (c.z * scale)) * inverse;
  }

  /// Sets the barycentric coordinates of a lane's hit.
  template <class Real>
  ALHAZEN_INLINE void fill(int lane, Hit<Real>& hit) const {
    const Real inverse_det = inverse.lane(lane);
    hit.b1 = e[1].lane(lane) * inverse_det;
    hit.b2 = e[2].lane(lane) * inverse_det;
  }

 private:
  /// Recomputes the edge functions of those hits that rounding may displace (is_displaced).
  ALHAZEN_RARE void recompute_displaced(const ShearedLanes<V>& a, const ShearedLanes<V>& b, const ShearedLanes<V>& c) {
    const V product = max(max(magnitude(b.x * c.y), magnitude(c.x * a.y)), magnitude(a.x * b.y));
    const auto extent = [&](V ShearedLanes<V>::*k) { return max(max(a.*k, b.*k), c.*k) - min(min(a.*k, b.*k), c.*k); };
    using Vertex = ShearedLanes<V>;
    using Real = typename V::Component;
    const V largest_extent = max(max(extent(&Vertex::x), extent(&Vertex::y)), extent(&Vertex::z));
    const V distance = magnitude(e[0] * a.z + e[1] * b.z + e[2] * c.z);
    uint32_t lanes = inside & less(V::all(displaced_hit<Real>) * distance, largest_extent * product);
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = std::countr_zero(lanes);
      Real edges[3];
      recompute_edge_functions<Real>({a.x.lane(lane), b.x.lane(lane), c.x.lane(lane)},
                                     {a.y.lane(lane), b.y.lane(lane), c.y.lane(lane)}, edges);
      for (int k = 0; k < 3; ++k) e[k] = choose(uint32_t{1} << lane, V::all(edges[k]), e[k]);
    }
  }

  template <class Vertex>
  ALHAZEN_INLINE static ShearedLanes<V> sheared(const Vertex& vertex, int v, const V (&origin)[3],
                                                const V (&shear)[3]) {
    const V p[3] = {vertex(v, 0), vertex(v, 1), vertex(v, 2)};
    return {p, origin, shear};
  }
};

}  // namespace ALHAZEN_CORE

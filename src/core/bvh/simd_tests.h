#pragma once

// The primitive tests of core/shapes on several lanes, operation by operation, so that hits are the same to the last
// bit, whatever the instruction set. A lane is a pair of a ray and a primitive: one ray and many primitives
// (simd_blocks.h) or many rays and one primitive (simd_packet.h).

#include <bit>

#include "core/bvh/traversal.h"
#include "core/simd/lanes.h"

namespace ALHAZEN_CORE {

/// Where the rays meet the triangles' planes (Woop, Benthin, Wald 2013), and what the error bound of that needs.
template <class V>
struct TriangleLanes {
  V x[3], y[3], z[3];  ///< vertices, sheared; z is not yet scaled
  V e[3];              ///< edge functions
  V inverse, t;
  uint32_t inside = 0;  ///< a bit for each lane; where none is set, `inverse` and `t` are not there

  /// `vertex(v, k)` is coordinate k of vertex v; k is 0 to 2 and stands for the ray's axes kx, ky, kz.
  template <class Vertex>
  ALHAZEN_INLINE TriangleLanes(const Vertex& vertex, const V (&origin)[3], const V (&shear)[3]) {
    for (int v = 0; v < 3; ++v) {
      z[v] = vertex(v, 2) - origin[2];
      x[v] = vertex(v, 0) - origin[0] - shear[0] * z[v];
      y[v] = vertex(v, 1) - origin[1] - shear[1] * z[v];
    }
    const V zero = V::all(0);
    e[0] = x[1] * y[2] - y[1] * x[2];
    e[1] = x[2] * y[0] - y[2] * x[0];
    e[2] = x[0] * y[1] - y[0] * x[1];
    inside = less_equal(zero, smaller(smaller(e[0], e[1]), e[2])) | less_equal(larger(larger(e[0], e[1]), e[2]), zero);
    if (inside == 0) return;
    // Where the sum is 0, t is infinite or not a number, and not taken.
    inverse = V::all(1) / (e[0] + e[1] + e[2]);
    t = (e[0] * (z[0] * shear[2]) + e[1] * (z[1] * shear[2]) + e[2] * (z[2] * shear[2])) * inverse;
  }

  /// Whether t of a lane lies beyond its error; if so, sets the barycentric weights.
  template <class Real>
  ALHAZEN_INLINE bool accept(int lane, Real shear_z, Hit<Real>& hit) const {
    Vec3<Real> p[3];
    for (int v = 0; v < 3; ++v) p[v] = {x[v].lane(lane), y[v].lane(lane), z[v].lane(lane) * shear_z};
    const Vec3<Real> edges{e[0].lane(lane), e[1].lane(lane), e[2].lane(lane)};
    const Real inverse_det = inverse.lane(lane);
    if (t.lane(lane) <= triangle_t_error(p, edges, inverse_det)) return false;
    hit.b1 = edges.y * inverse_det;
    hit.b2 = edges.z * inverse_det;
    return true;
  }
};

/// Where the rays meet the spheres.
template <class V>
struct SphereLanes {
  V t;
  uint32_t crossed = 0;  ///< a bit for each lane; where none is set, `t` is not there

  /// Spheres about `f` from their centres to the rays' origins.
  ALHAZEN_INLINE SphereLanes(const V (&f)[3], const V (&d)[3], const V& radius) {
    const V zero = V::all(0);
    const V b = zero - (f[0] * d[0] + f[1] * d[1] + f[2] * d[2]);
    const V closest[3] = {f[0] + d[0] * b, f[1] + d[1] * b, f[2] + d[2] * b};
    const V discriminant =
        radius * radius - (closest[0] * closest[0] + closest[1] * closest[1] + closest[2] * closest[2]);
    crossed = less_equal(zero, discriminant);
    if (crossed == 0) return;
    const V root = square_root(discriminant);
    const V q = where_less(b, zero, b - root, b + root);
    const V c = f[0] * f[0] + f[1] * f[1] + f[2] * f[2] - radius * radius;
    const V other = c / q;
    const V near = where_less(b, zero, q, other), far = where_less(b, zero, other, q);
    t = where_less(zero, c, near, far);
  }

  template <class Real>
  ALHAZEN_INLINE bool accept(Hit<Real>& hit) const {
    hit.b1 = hit.b2 = 0;
    return true;
  }
};

}  // namespace ALHAZEN_CORE

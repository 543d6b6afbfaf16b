#pragma once

// Watertight intersection of triangles (Woop, Benthin, Wald 2013, JCGT 2(1)), and sampling of their area.

#include <limits>

#include "core/math/bounds.h"
#include "core/math/ray.h"
#include "core/math/scalar.h"
#include "core/scene_view.h"
#include "core/shapes/sheared_ray.h"

namespace ALHAZEN_CORE {

/// Returns whether a triangle is much longer than wide.
template <class Real>
bool is_narrow(const Vec3<Real>& p0, const Vec3<Real>& p1, const Vec3<Real>& p2) {
  const Vec3<Real> a = p1 - p0, b = p2 - p0;
  const Real longest = max(max(length_squared(a), length_squared(b)), length_squared(p2 - p1));
  return sqr(longest) > 64 * 64 * length_squared(cross(a, b));
}

/// An edge function is a difference of two products. If the ray's origin is close to a triangle that is much longer
/// than wide, the edge functions are small beside the products, and rounding of the products displaces the hit by up to
///   extent of the triangle * largest product / determinant * 2^-22 (2^-51 in double);
/// t may even get the wrong sign. In scenes with such triangles, the edge functions are computed again, from exact
/// products, if that is more than 2^-13 of the distance.
template <class Real>
inline constexpr Real displaced_hit = Real(0x1p-13) / (2 * std::numeric_limits<Real>::epsilon());

/// Returns a * b - c * d, with the products as sums of two numbers (Dekker 1971, with the splitting of Veltkamp).
template <class Real>
Real exact_difference_of_products(Real a, Real b, Real c, Real d) {
  struct Product {
    Real rounded, error;
    Product(Real x, Real y) : rounded(x * y) {
      constexpr Real split = Real(uint64_t{1} << (std::numeric_limits<Real>::digits + 1) / 2) + 1;
      const Real sx = split * x, sy = split * y, x1 = sx - (sx - x), y1 = sy - (sy - y), x2 = x - x1, y2 = y - y1;
      error = x2 * y2 - (((rounded - x1 * y1) - x2 * y1) - x1 * y2);
    }
  };
  const Product ab(a, b), cd(c, d);
  return (ab.rounded - cd.rounded) + (ab.error - cd.error);
}

/// Products of floats are exact in double.
inline double exact_difference_of_products(float a, float b, float c, float d) {
  return static_cast<double>(a) * static_cast<double>(b) - static_cast<double>(c) * static_cast<double>(d);
}

/// Recomputes the edge functions of a triangle that was hit, from its vertices in the sheared space of the ray. If the
/// ray passes the triangle within rounding, they become the barycentric coordinates of the point nearest to the ray on
/// the first edge that it passes. It would not do to set the negative one to 0: in a long triangle seen at a grazing
/// angle, the hit would move far along the edge, and t could get the wrong sign.
template <class Real>
ALHAZEN_RARE void recompute_edge_functions(const Real (&x)[3], const Real (&y)[3], Real (&e)[3]) {
  decltype(exact_difference_of_products(x[0], y[0], y[0], x[0])) exact[3], sum = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    exact[i] = exact_difference_of_products(x[j], y[k], y[j], x[k]);
    sum += exact[i];
  }
  for (int i = 0; i < 3; ++i) e[i] = static_cast<Real>(sum < 0 ? -exact[i] : exact[i]);
  for (int i = 0; i < 3; ++i) {
    if (!(e[i] < 0)) continue;
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const Real dx = x[k] - x[j], dy = y[k] - y[j];
    const Real along = -(x[j] * dx + y[j] * dy) / (sqr(dx) + sqr(dy));
    e[i] = 0;
    e[k] = min(max(along, Real(0)), Real(1));
    e[j] = 1 - e[k];
    return;
  }
}

/// Returns whether rounding may displace the hit on a triangle, given in the sheared space of the ray.
template <class Real>
ALHAZEN_RARE bool is_displaced(const Vec3<Real> (&p)[3], const Vec3<Real>& e) {
  const Real product = max(max(std::abs(p[1].x * p[2].y), std::abs(p[2].x * p[0].y)), std::abs(p[0].x * p[1].y));
  const Vec3<Real> low = min(min(p[0], p[1]), p[2]), high = max(max(p[0], p[1]), p[2]);
  const Real extent = max(max(high.x - low.x, high.y - low.y), high.z - low.z);
  return displaced_hit<Real> * std::abs(e.x * p[0].z + e.y * p[1].z + e.z * p[2].z) < extent * product;
}

/// Intersects the triangle p0 p1 p2: sets t and the barycentric coordinates of p1 and p2. Rays through a shared edge or
/// vertex always hit one of the triangles; degenerate triangles are never hit. If |t| is within its rounding error, the
/// sign of t is unreliable. Rays are spawned so that this only happens for the triangle that they start on
/// (`Ray::left`, `edge_clearance`).
template <class Real>
ALHAZEN_HD bool intersect_triangle(const ShearedRay<Real>& ray, const Vec3<Real>& p0, const Vec3<Real>& p1,
                                   const Vec3<Real>& p2, Real t_max, Real& t, Real& b1, Real& b2) {
  const auto sheared = [&](const Vec3<Real>& p) {
    const Vec3<Real> q = Vec3<Real>{p[ray.kx], p[ray.ky], p[ray.kz]} - ray.origin;
    return Vec3<Real>{multiply_add(-ray.shear.x, q.z, q.x), multiply_add(-ray.shear.y, q.z, q.y), q.z};
  };
  const Vec3<Real> p_t[3] = {sheared(p0), sheared(p1), sheared(p2)};
  Vec3<Real> e{difference_of_products(p_t[1].x, p_t[2].y, p_t[1].y, p_t[2].x),
               difference_of_products(p_t[2].x, p_t[0].y, p_t[2].y, p_t[0].x),
               difference_of_products(p_t[0].x, p_t[1].y, p_t[0].y, p_t[1].x)};
  if ((e.x < 0 || e.y < 0 || e.z < 0) && (e.x > 0 || e.y > 0 || e.z > 0)) return false;
  Real det = e.x + e.y + e.z;
#if !defined(__CUDA_ARCH__)  // there, fused operations make the differences exact
  if (ALHAZEN_UNLIKELY(ray.checks_narrow_triangles != 0) && is_displaced(p_t, e)) {
    Real edges[3];
    recompute_edge_functions({p_t[0].x, p_t[1].x, p_t[2].x}, {p_t[0].y, p_t[1].y, p_t[2].y}, edges);
    e = {edges[0], edges[1], edges[2]};
    det = e.x + e.y + e.z;
  }
#endif
  if (det == 0) return false;
  const Real inverse_det = Real(1) / det;
  const Vec3<Real> z = Vec3<Real>{p_t[0].z, p_t[1].z, p_t[2].z} * ray.shear.z;
  const Real distance = dot(e, z) * inverse_det;
  if (!(distance > 0 && distance <= t_max)) return false;
  t = distance;
  b1 = e.y * inverse_det;
  b2 = e.z * inverse_det;
  return true;
}

template <class Real>
ALHAZEN_HD ALHAZEN_INLINE bool intersect_record(const SceneView<Real>& scene, const TriangleRecord& triangle,
                                                PrimitiveId id, const Ray<Real>&, const ShearedRay<Real>& sheared,
                                                Real t_max, Hit<Real>& hit) {
  if (id == sheared.left) return false;
  const uint32_t* v = triangle.vertex;
  return intersect_triangle(sheared, scene.positions[v[0]], scene.positions[v[1]], scene.positions[v[2]], t_max, hit.t,
                            hit.b1, hit.b2);
}

/// Returns the bounding box, padded by the rounding errors of the vertices in the sheared space of a ray that starts or
/// ends near the triangle. They grow with its largest extent, also along the other axes; without the padding a hit of
/// intersect_triangle may be outside the box.
template <class Real>
Bounds3<Real> bounds_of(const SceneView<Real>& scene, const TriangleRecord& triangle) {
  Bounds3<Real> box;
  for (const uint32_t v : triangle.vertex) box.extend(scene.positions[v]);
  const Real padding = max_component(box.high - box.low) * rounding_bound<Real>(10);
  return {box.low - splat(padding), box.high + splat(padding)};
}

/// Samples a point uniformly over the area of a triangle, with pdf 1 / area, and returns the barycentric coordinates of
/// vertices 0 and 1 (Heitz 2019, "A Low-Distortion Map Between Triangle and Square").
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec2<Real> sample_triangle(const Vec2<Real>& u) {
  if (u.x < u.y) {
    const Real b0 = u.x * Real(0.5);
    return {b0, u.y - b0};
  }
  const Real b1 = u.y * Real(0.5);
  return {u.x - b1, b1};
}

}  // namespace ALHAZEN_CORE

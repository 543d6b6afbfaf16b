#pragma once

// Watertight triangles (Woop, Benthin, Wald 2013, JCGT 2(1)), and triangles as lights sampled by area.

#include "core/math/ray.h"
#include "core/math/scalar.h"
#include "core/shapes/records.h"

namespace ALHAZEN_CORE {

/// The ray as the triangle test wants it: axes permuted so that the direction is longest along the last, and the shear
/// that turns the direction into that axis. Made once a ray.
template <class Real>
struct ShearedRay {
  Vec3<Real> origin;  ///< along kx, ky and kz
  Vec3<Real> shear;
  int kx, ky, kz;
};

template <class Real>
ALHAZEN_HD ALHAZEN_HOT ShearedRay<Real> shear_ray(const Ray<Real>& ray) {
  ShearedRay<Real> s;
  s.kz = max_axis(abs(ray.direction));
  s.kx = s.kz == 2 ? 0 : s.kz + 1;
  s.ky = s.kx == 2 ? 0 : s.kx + 1;
  s.origin = {ray.origin[s.kx], ray.origin[s.ky], ray.origin[s.kz]};
  const Real inverse = Real(1) / ray.direction[s.kz];
  s.shear = {ray.direction[s.kx] * inverse, ray.direction[s.ky] * inverse, inverse};
  return s;
}

/// A bound on the rounding of t in `intersect_triangle` (PBR 4th ed., 6.8.7): above it t has the right sign. `p` are
/// the sheared vertices, `inverse_det` the reciprocal of the sum of edge functions `e`.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Real triangle_t_error(const Vec3<Real> p[3], const Vec3<Real>& e, Real inverse_det) {
  const auto largest = [](Real a, Real b, Real c) { return larger(std::abs(a), larger(std::abs(b), std::abs(c))); };
  const Real max_x = largest(p[0].x, p[1].x, p[2].x);
  const Real max_y = largest(p[0].y, p[1].y, p[2].y);
  const Real max_z = largest(p[0].z, p[1].z, p[2].z);
  const Real max_e = largest(e.x, e.y, e.z);
  const Real error_x = rounding_bound<Real>(5) * (max_x + max_z);
  const Real error_y = rounding_bound<Real>(5) * (max_y + max_z);
  const Real error_z = rounding_bound<Real>(3) * max_z;
  const Real error_e = 2 * (rounding_bound<Real>(2) * max_x * max_y + error_y * max_x + error_x * max_y);
  return 3 * (rounding_bound<Real>(3) * max_e * max_z + error_e * max_z + error_z * max_e) * std::abs(inverse_det);
}

template <class Real>
ALHAZEN_HD bool intersect_triangle(const ShearedRay<Real>& ray, const Vec3<Real>& p0, const Vec3<Real>& p1,
                                   const Vec3<Real>& p2, Real t_max, Real& t, Real& b1, Real& b2);

/// Decides where rounding hides the sign of t: by the same test in double, where vertices and origin of a float ray are
/// exact. Rays start off the surface that they leave (offset_origin), so that surface is behind them and one that joins
/// it at an edge is ahead. In double such hits count as behind: one ray in 10^13 comes so close to an edge.
template <class Real>
ALHAZEN_HD ALHAZEN_RARE bool intersect_in_double(const ShearedRay<Real>& ray, const Vec3<Real>& p0,
                                                 const Vec3<Real>& p1, const Vec3<Real>& p2, Real& t, Real& b1,
                                                 Real& b2) {
  if constexpr (sizeof(Real) < sizeof(double)) {
    const ShearedRay<double> exact{convert<double>(ray.origin), convert<double>(ray.shear), ray.kx, ray.ky, ray.kz};
    double distance, weight1, weight2;
    if (!intersect_triangle(exact, convert<double>(p0), convert<double>(p1), convert<double>(p2), infinity<double>,
                            distance, weight1, weight2))
      return false;
    t = static_cast<Real>(distance);
    b1 = static_cast<Real>(weight1);
    b2 = static_cast<Real>(weight2);
    return true;
  } else {
    return false;
  }
}

/// Intersects the triangle p0 p1 p2 at a distance in (0, t_max]: sets t and the barycentric weights. Rays through a
/// shared edge or vertex always hit one of the triangles; degenerate triangles are never hit.
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
  const Real det = e.x + e.y + e.z;
  if (det == 0) return false;
  const Real inverse_det = Real(1) / det;
  const Vec3<Real> z = Vec3<Real>{p_t[0].z, p_t[1].z, p_t[2].z} * ray.shear.z;
  const Real distance = dot(e, z) * inverse_det;
  if (!(distance > 0 && distance <= t_max)) return false;
  const Vec3<Real> scaled[3] = {{p_t[0].x, p_t[0].y, z.x}, {p_t[1].x, p_t[1].y, z.y}, {p_t[2].x, p_t[2].y, z.z}};
  if (distance <= triangle_t_error(scaled, e, inverse_det))
    return intersect_in_double(ray, p0, p1, p2, t, b1, b2) && t <= t_max;
  t = distance;
  b1 = e.y * inverse_det;
  b2 = e.z * inverse_det;
  return true;
}

/// A point on the triangle by area, from two uniform numbers: barycentric weights of vertices 0 and 1, pdf 1 / area
/// (Heitz 2019, "A Low-Distortion Map Between Triangle and Square").
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

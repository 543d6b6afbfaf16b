#pragma once

// Spheres: intersection that stays accurate for radii of thousands, and sampling by the cone that they subtend.

#include "core/math/frame.h"
#include "core/math/ray.h"
#include "core/math/scalar.h"

namespace ALHAZEN_CORE {

/// Meets the sphere at a distance in (0, t_max]: the discriminant from the vector to the closest point and the roots
/// without cancellation (Haines, Gunther, Akenine-Moller 2019, Ray Tracing Gems ch. 7).
template <class Real>
ALHAZEN_HD bool intersect_sphere(const Ray<Real>& ray, const Vec3<Real>& center, Real radius, Real t_max, Real& t) {
  const Vec3<Real> f = ray.origin - center;
  const Real b = -dot(f, ray.direction);
  const Vec3<Real> closest = f + ray.direction * b;
  const Real discriminant = radius * radius - dot(closest, closest);
  if (!(discriminant >= 0)) return false;
  const Real root = std::sqrt(discriminant);
  const Real q = b >= 0 ? b + root : b - root;
  const Real c = dot(f, f) - radius * radius;
  const Real other = c / q;
  const Real near = b >= 0 ? other : q;
  const Real far = b >= 0 ? q : other;
  // Outside (c > 0) the near root counts, inside only the far one: the near root is then behind, or rounding.
  const Real distance = c > 0 ? near : far;
  if (!(distance > 0 && distance <= t_max)) return false;
  t = distance;
  return true;
}

/// Cone of directions from `point` that meets the sphere: cosine of its half angle, and 1 minus that cosine without
/// cancellation. False where the point is inside or on the sphere.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT bool subtended_cone(const Vec3<Real>& center, Real radius, const Vec3<Real>& point,
                                           Real& cos_max, Real& one_minus_cos_max) {
  const Real distance_squared = length_squared(center - point);
  const Real sin2 = radius * radius / distance_squared;
  if (!(sin2 < Real(0.99999))) return false;
  cos_max = safe_sqrt(1 - sin2);
  one_minus_cos_max = sin2 / (1 + cos_max);
  return true;
}

/// A unit direction from `point` towards the sphere, uniform over the cone that it subtends, or, from inside, towards
/// a point uniform over its area. `normal_at` receives the outward unit normal where the direction meets it, `pdf` the
/// density over solid angle.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec3<Real> sample_sphere(const Vec3<Real>& center, Real radius, const Vec3<Real>& point,
                                                const Vec2<Real>& u, Vec3<Real>& normal_at, Real& pdf) {
  const Real phi = 2 * pi<Real> * u.y;
  Real cos_max, one_minus_cos_max;
  if (!subtended_cone(center, radius, point, cos_max, one_minus_cos_max)) {
    const Real z = 1 - 2 * u.x, r = safe_sqrt(1 - z * z);
    const auto [sine, cosine] = sine_cosine_of_turn(phi);
    normal_at = {r * cosine, r * sine, z};
    const Vec3<Real> to_light = center + normal_at * radius - point;
    const Real distance_squared = length_squared(to_light);
    const Vec3<Real> direction = to_light * (1 / std::sqrt(distance_squared));
    const Real cos_light = abs_dot(direction, normal_at);
    pdf = cos_light > 0 ? distance_squared / (cos_light * 4 * pi<Real> * radius * radius) : 0;
    return direction;
  }
  const Frame<Real> frame = frame_about(normalize(center - point));
  const Real one_minus_cos = u.x * one_minus_cos_max;
  const Real cos_theta = 1 - one_minus_cos;
  const Real sin_theta = safe_sqrt(one_minus_cos * (1 + cos_theta));
  const auto [sin_phi, cos_phi] = sine_cosine_of_turn(phi);
  // The normal from the angles alone (PBR 4th ed., 6.2.4): positions far out do not resolve a small sphere.
  const Real sin2_max = one_minus_cos_max * (1 + cos_max);
  const Real share = sin_theta * sin_theta / sin2_max;
  const Real cos_alpha = std::sqrt(sin2_max) * share + cos_theta * safe_sqrt(1 - share);
  const Real sin_alpha = safe_sqrt(1 - cos_alpha * cos_alpha);
  normal_at = frame.to_world({sin_alpha * cos_phi, sin_alpha * sin_phi, -cos_alpha});
  pdf = Real(0.5) * inv_pi<Real> / one_minus_cos_max;
  return frame.to_world({sin_theta * cos_phi, sin_theta * sin_phi, cos_theta});
}

/// Density of `sample_sphere` over solid angle for a direction that meets the sphere at distance t with the outward
/// unit normal `normal_at`.
template <class Real>
ALHAZEN_HD Real pdf_sphere(const Vec3<Real>& center, Real radius, const Vec3<Real>& point, const Vec3<Real>& direction,
                           Real t, const Vec3<Real>& normal_at) {
  Real cos_max, one_minus_cos_max;
  if (subtended_cone(center, radius, point, cos_max, one_minus_cos_max))
    return Real(0.5) * inv_pi<Real> / one_minus_cos_max;
  const Real cos_light = abs_dot(direction, normal_at);
  return cos_light > 0 ? t * t / (cos_light * 4 * pi<Real> * radius * radius) : 0;
}

/// (u, v) of an outward unit normal in the sphere's own axes: u over the azimuth from x, v from the south pole up.
template <class Real>
ALHAZEN_HD Vec2<Real> sphere_uv(const Vec3<Real>& local_normal) {
  Real phi = std::atan2(local_normal.y, local_normal.x);
  if (phi < 0) phi += 2 * pi<Real>;
  const Real theta = std::acos(clamp(local_normal.z, Real(-1), Real(1)));
  return {phi * Real(0.5) * inv_pi<Real>, 1 - theta * inv_pi<Real>};
}

}  // namespace ALHAZEN_CORE

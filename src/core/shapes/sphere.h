#pragma once

// Spheres: intersection that stays accurate for radii in the thousands, the surface at a hit, and sampling of the cone
// that they subtend.

#include <limits>

#include "core/math/bounds.h"
#include "core/math/frame.h"
#include "core/math/ray.h"
#include "core/math/scalar.h"
#include "core/scene_view.h"
#include "core/shapes/record_lanes.h"
#include "core/shapes/sheared_ray.h"
#include "core/shapes/surface_interaction.h"

namespace ALHAZEN_CORE {

/// Intersects the sphere. The discriminant is computed from the vector to the closest point, and the roots without
/// cancellation (Haines, Gunther, Akenine-Moller 2019, Ray Tracing Gems ch. 7).
template <class Real>
ALHAZEN_HD bool intersect_sphere(const Ray<Real>& ray, const Vec3<Real>& centre, Real radius, Real t_max, Real& t) {
  const Vec3<Real> f = ray.origin - centre;
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
  // From outside (c > 0) the near root is the hit, from inside the far one: the near root is then negative or due to
  // rounding.
  const Real distance = c > 0 ? near : far;
  if (!(distance > 0 && distance <= t_max)) return false;
  t = distance;
  return true;
}

template <class Real>
struct Sphere {
  Vec3<Real> centre;
  Real radius;
};

template <class Real>
ALHAZEN_HD ALHAZEN_INLINE Sphere<Real> sphere_at(const SphereRecord<Real>& sphere, Real) {
  return {sphere.centre, sphere.radius};
}

/// Returns the sphere at `time`.
template <class Real>
ALHAZEN_HD ALHAZEN_INLINE Sphere<Real> sphere_at(const MovingSphereRecord<Real>& sphere, Real time) {
  return {sphere.centre + sphere.motion * time, sphere.radius};
}

/// A record of a static or moving sphere.
template <class Record, class Real>
concept SphereRecordOf = requires(const Record& record, Real time) {
  sphere_at(record, time);
};

template <class Real, SphereRecordOf<Real> Record>
ALHAZEN_HD ALHAZEN_INLINE bool intersect_record(const SceneView<Real>&, const Record& record, PrimitiveId,
                                                const Ray<Real>& ray, const ShearedRay<Real>&, Real t_max,
                                                Hit<Real>& hit) {
  const Sphere<Real> sphere = sphere_at(record, ray.time);
  return intersect_sphere(ray, sphere.centre, sphere.radius, t_max, hit.t);
}

/// Intersects rays with spheres on SIMD lanes, by the same operations in the same order.
template <class V>
struct SphereLanes {
  V t;
  uint32_t crossed = 0;  ///< one bit per lane whose sphere may be hit; if none is set, `t` is not computed

  /// `f` is the vector from the centres to the origins of the rays, `d` the unit directions.
  ALHAZEN_INLINE SphereLanes(const V (&f)[3], const V (&d)[3], const V& radius) {
    const V zero = V::all(0);
    const V b = zero - (f[0] * d[0] + f[1] * d[1] + f[2] * d[2]);
    const V closest[3] = {f[0] + d[0] * b, f[1] + d[1] * b, f[2] + d[2] * b};
    const V discriminant =
        radius * radius - (closest[0] * closest[0] + closest[1] * closest[1] + closest[2] * closest[2]);
    crossed = less_equal(zero, discriminant);
    if (crossed == 0) return;
    const V c = f[0] * f[0] + f[1] * f[1] + f[2] * f[2] - radius * radius;
    // If the origin is outside and the sphere behind it, both distances are negative and need not be computed.
    crossed &= ~(less(b, zero) & less(zero, c));
    if (crossed == 0) return;
    const V root = square_root(discriminant);
    const V q = where_less(b, zero, b - root, b + root);
    const V other = c / q;
    const V near = where_less(b, zero, q, other), far = where_less(b, zero, other, q);
    t = where_less(zero, c, near, far);
  }

  template <class Real>
  ALHAZEN_INLINE void fill(int, Hit<Real>& hit) const {
    hit.b1 = hit.b2 = 0;
  }
};

template <class V, class Real, class Read>
ALHAZEN_INLINE SphereLanes<V> intersect_lanes(const NumbersOf<SphereRecord<Real>, Read>& sphere,
                                              const RayLanes<V>& ray) {
  const V f[3] = {ray.origin[0] - sphere[0], ray.origin[1] - sphere[1], ray.origin[2] - sphere[2]};
  return {f, ray.direction, sphere[3]};
}

template <class V, class Real, class Read>
ALHAZEN_INLINE SphereLanes<V> intersect_lanes(const NumbersOf<MovingSphereRecord<Real>, Read>& sphere,
                                              const RayLanes<V>& ray) {
  const auto from_centre = [&](int axis) { return ray.origin[axis] - (sphere[axis] + sphere[4 + axis] * ray.time); };
  const V f[3] = {from_centre(0), from_centre(1), from_centre(2)};
  return {f, ray.direction, sphere[3]};
}

/// Returns the bounding box, padded by the rounding error of centre +- radius.
template <class Real>
Bounds3<Real> bounds_of(const Sphere<Real>& sphere) {
  const Vec3<Real> r =
      splat(sphere.radius) + (abs(sphere.centre) + splat(sphere.radius)) * (2 * std::numeric_limits<Real>::epsilon());
  return {sphere.centre - r, sphere.centre + r};
}

template <class Real, SphereRecordOf<Real> Record>
Bounds3<Real> bounds_at(const SceneView<Real>&, const Record& record, Real time) {
  return bounds_of(sphere_at(record, time));
}

template <class Real, SphereRecordOf<Real> Record>
Bounds3<Real> bounds_of(const SceneView<Real>& scene, const Record& record) {
  Bounds3<Real> box = bounds_at(scene, record, Real(0));
  box.extend(bounds_at(scene, record, Real(1)));
  return box;
}

/// Computes the cone of directions from `point` that the sphere subtends: the cosine of its half angle, and 1 minus
/// that cosine without cancellation. Returns false if the point is inside; the cone is then a hemisphere.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT bool subtended_cone(const Vec3<Real>& centre, Real radius, const Vec3<Real>& point,
                                           Real& cos_max, Real& one_minus_cos_max) {
  const Real distance_squared = length_squared(centre - point);
  const Real sin2 = radius * radius / distance_squared;
  const bool is_outside = sin2 < 1;
  cos_max = is_outside ? safe_sqrt(1 - sin2) : Real(0);
  one_minus_cos_max = is_outside ? sin2 / (1 + cos_max) : Real(1);
  return is_outside;
}

/// Returns the pdf over solid angle of sampling the sphere's area uniformly, for a point along `direction` at the given
/// squared distance with normal `outward`.
template <class Real>
ALHAZEN_HD Real pdf_of_sphere_area(Real radius, const Vec3<Real>& direction, Real distance_squared,
                                   const Vec3<Real>& outward) {
  const Real cos_light = abs_dot(direction, outward);
  return cos_light > 0 ? distance_squared / (cos_light * 4 * pi<Real> * radius * radius) : 0;
}

/// Samples a point uniformly over the area of the sphere, all of which is visible from inside and from the sphere
/// itself. The results are those of `sample_sphere`.
template <class Real>
ALHAZEN_HD Vec3<Real> sample_sphere_area(const Vec3<Real>& centre, Real radius, const Vec3<Real>& point,
                                         const Vec2<Real>& u, Vec3<Real>& normal_at, Real& pdf) {
  const Real z = 1 - 2 * u.x, r = safe_sqrt(1 - z * z);
  const auto [sine, cosine] = sine_cosine_of_turn(2 * pi<Real> * u.y);
  normal_at = {r * cosine, r * sine, z};
  const Vec3<Real> to_light = centre + normal_at * radius - point;
  const Real distance_squared = length_squared(to_light);
  if (!(distance_squared > 0)) {
    pdf = 0;
    return normal_at;
  }
  const Vec3<Real> direction = to_light * (1 / std::sqrt(distance_squared));
  pdf = pdf_of_sphere_area(radius, direction, distance_squared, normal_at);
  return direction;
}

/// Samples a unit direction from `point` towards the sphere: from outside uniformly over the cone that it subtends,
/// from inside or on the sphere towards a point uniform over its area. The caller passes `is_on_sphere` because
/// rounding would otherwise decide, with large errors far from the origin. Sets `normal_at` to the outward unit normal
/// at the sampled point and `pdf` to the density over solid angle.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Vec3<Real> sample_sphere(const Vec3<Real>& centre, Real radius, const Vec3<Real>& point,
                                                bool is_on_sphere, const Vec2<Real>& u, Vec3<Real>& normal_at,
                                                Real& pdf) {
  Real cos_max, one_minus_cos_max;
  if (is_on_sphere || !subtended_cone(centre, radius, point, cos_max, one_minus_cos_max))
    return sample_sphere_area(centre, radius, point, u, normal_at, pdf);
  const Real phi = 2 * pi<Real> * u.y;
  const Frame<Real> frame = frame_about(normalize(centre - point));
  const Real one_minus_cos = u.x * one_minus_cos_max;
  const Real cos_theta = 1 - one_minus_cos;
  const Real sin_theta = safe_sqrt(one_minus_cos * (1 + cos_theta));
  const auto [sin_phi, cos_phi] = sine_cosine_of_turn(phi);
  // The normal is computed from the angles (PBR 4th ed., 6.2.4), since distant positions do not resolve a small sphere.
  const Real sin2_max = one_minus_cos_max * (1 + cos_max);
  const Real sin2_fraction = sin_theta * sin_theta / sin2_max;
  const Real cos_alpha = std::sqrt(sin2_max) * sin2_fraction + cos_theta * safe_sqrt(1 - sin2_fraction);
  const Real sin_alpha = safe_sqrt(1 - cos_alpha * cos_alpha);
  normal_at = frame.to_world({sin_alpha * cos_phi, sin_alpha * sin_phi, -cos_alpha});
  pdf = Real(0.5) * inv_pi<Real> / one_minus_cos_max;
  return frame.to_world({sin_theta * cos_phi, sin_theta * sin_phi, cos_theta});
}

/// Returns the pdf of `sample_sphere` over solid angle for a direction that hits the sphere at distance t, where the
/// outward unit normal is `outward`. A ray from inside or from the sphere itself hits the inside, which selects the
/// case independently of how the distance of `point` from the centre is rounded.
template <class Real>
ALHAZEN_HD Real pdf_sphere(const Vec3<Real>& centre, Real radius, const Vec3<Real>& point, const Vec3<Real>& direction,
                           Real t, const Vec3<Real>& outward) {
  if (dot(direction, outward) > 0) return pdf_of_sphere_area(radius, direction, t * t, outward);
  Real cos_max, one_minus_cos_max;
  subtended_cone(centre, radius, point, cos_max, one_minus_cos_max);
  return Real(0.5) * inv_pi<Real> / one_minus_cos_max;
}

/// Returns the uv of an outward unit normal in the sphere's object space: u follows the azimuth from x, v goes from 0
/// at the south pole to 1 at the north pole.
template <class Real>
ALHAZEN_HD Vec2<Real> sphere_uv(const Vec3<Real>& local_normal) {
  Real phi = std::atan2(local_normal.y, local_normal.x);
  if (phi < 0) phi += 2 * pi<Real>;
  const Real theta = std::acos(clamp(local_normal.z, Real(-1), Real(1)));
  return {phi * Real(0.5) * inv_pi<Real>, 1 - theta * inv_pi<Real>};
}

/// Sets the interaction on a sphere. The hit point is projected onto the sphere along the radius, so its error depends
/// only on centre and radius, not on the length of the ray.
template <class Real, SphereRecordOf<Real> Record>
ALHAZEN_HD ALHAZEN_HOT void set_interaction(const SceneView<Real>& scene, const Record& record, const Ray<Real>& ray,
                                            const Hit<Real>& hit, SurfaceInteraction<Real>& si) {
  const auto [centre, radius] = sphere_at(record, ray.time);
  const Vec3<Real> outward = normalize(ray.origin - centre + ray.direction * hit.t);
  const Vec3<Real> from_centre = outward * radius;
  si.position = centre + from_centre;
  si.position_error = (abs(centre) + splat(radius)) * rounding_bound<Real>(8);
  si.normal = scene.surfaces[record.surface].flip_normal ? -outward : outward;
  si.shading_normal = si.normal;
  si.uv = {};
  if (record.frame != no_sphere_frame) {
    const SphereFrame<Real>& axes = scene.sphere_frames[record.frame];
    si.uv = sphere_uv(Vec3<Real>{dot(outward, axes.x), dot(outward, axes.y), dot(outward, axes.z)});
  }
  si.surface = record.surface;
}

template <class Real, SphereRecordOf<Real> Record>
ALHAZEN_HD Real uv_density_of(const SceneView<Real>& scene, const Record& record, const Hit<Real>&, Real,
                              const Vec3<Real>& normal, uint32_t) {
  if (record.frame == no_sphere_frame) return 0;
  // u = phi / (2 pi), v = theta / pi, area = r^2 sin(theta) dtheta dphi.
  const Real cosine = dot(normal, scene.sphere_frames[record.frame].z);
  const Real sine = max(safe_sqrt(1 - cosine * cosine), Real(1e-3));
  return Real(0.5) * inv_pi<Real> * inv_pi<Real> / (record.radius * record.radius * sine);
}

/// Returns the tangents of a sphere: u goes round the polar axis from x towards y of its object space, v from the south
/// pole to the north pole.
template <class Real>
ALHAZEN_HD SurfaceTangents<Real> sphere_tangents(const SphereFrame<Real>& axes, Real radius,
                                                 const Vec3<Real>& outward) {
  // The rotation from x to y is counterclockwise about z, or clockwise if the sphere is mirrored.
  const Real turn = dot(cross(axes.x, axes.y), axes.z) < 0 ? -radius : radius;
  const Vec3<Real> around = cross(axes.z, outward) * turn;
  const Real ring = length(around);
  if (!(ring > 0)) return {};
  const Vec3<Real> up = cross(outward, around * (1 / ring)) * turn;
  return {around * (2 * pi<Real>), up * pi<Real>};
}

template <class Real, SphereRecordOf<Real> Record>
ALHAZEN_HD SurfaceTangents<Real> tangents_of(const SceneView<Real>& scene, const Record& record, const Hit<Real>&,
                                             const SurfaceInteraction<Real>& si) {
  if (record.frame == no_sphere_frame) return {};
  const Vec3<Real> outward = scene.surfaces[si.surface].flip_normal ? -si.normal : si.normal;
  return sphere_tangents(scene.sphere_frames[record.frame], record.radius, outward);
}

}  // namespace ALHAZEN_CORE

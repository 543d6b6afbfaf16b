#pragma once

// Cameras: perspective and orthographic ones with a thin lens, and ones that see the whole sphere of directions.

#include "core/cameras/camera_kind.h"
#include "core/lights/sphere_mapping.h"
#include "core/math/ray.h"
#include "core/math/vec.h"
#include "core/sampling/warp.h"

namespace ALHAZEN_CORE {

template <class Real>
struct CameraRecord {
  /// Maps raster space (pixels, y down) to the plane z = 1 of camera space: x = x_scale * px + x_offset, and y
  /// likewise. The target is the plane z = 0 for orthographic cameras, and the unit square, y down, for cameras of the
  /// whole sphere.
  Real x_scale, x_offset, y_scale, y_offset;
  Real lens_radius, focal_distance;
  Real world_from_camera[3][4];
  /// Solid angle of a quarter of a pixel at the centre of the image; for orthographic cameras its area in world space.
  Real footprint;
  Real inverse_scale;  ///< 1 / the length in world space of camera space's z axis
  CameraKind kind;
};

template <class Real>
ALHAZEN_HD Vec3<Real> camera_axis(const CameraRecord<Real>& camera) {
  const auto& m = camera.world_from_camera;
  return Vec3<Real>{m[0][2], m[1][2], m[2][2]} * camera.inverse_scale;
}

/// World-space area that a quarter of a pixel covers on a surface at `position` with unit normal `normal`, as the
/// camera sees it directly. It is a quarter because pixels are sampled more than once. It is bounded at grazing angles.
template <class Real>
ALHAZEN_HD Real pixel_footprint(const CameraRecord<Real>& camera, const Vec3<Real>& position,
                                const Vec3<Real>& normal) {
  constexpr Real min_cosine = Real(1.0 / 16);
  const Vec3<Real> axis = camera_axis(camera);
  if (camera.kind == CameraKind::orthographic) return camera.footprint / max(std::abs(dot(normal, axis)), min_cosine);
  const auto& m = camera.world_from_camera;
  const Vec3<Real> from_camera = position - Vec3<Real>{m[0][3], m[1][3], m[2][3]};
  const Real squared = length_squared(from_camera), distance = std::sqrt(squared);
  // Cosine times distance.
  const Real facing = max(std::abs(dot(normal, from_camera)), min_cosine * distance);
  if (!(facing > 0)) return 0;
  if (camera.kind != CameraKind::perspective) return camera.footprint * squared * distance / facing;
  // The solid angle of a pixel falls with the cube of the cosine to the optical axis.
  const Real depth = std::abs(dot(axis, from_camera));
  return camera.footprint * depth * depth * depth / facing;
}

/// Generates rays in camera space for cameras that are not perspective. pbrt's spherical cameras have y up.
template <class Real>
ALHAZEN_HD void other_camera_ray(const CameraRecord<Real>& camera, const Vec2<Real>& film, const Vec2<Real>& u_lens,
                                 Vec3<Real>& origin, Vec3<Real>& direction) {
  const Real x = camera.x_scale * film.x + camera.x_offset, y = camera.y_scale * film.y + camera.y_offset;
  if (camera.kind == CameraKind::orthographic) {
    origin = {x, y, 0};
    direction = {0, 0, 1};
    if (camera.lens_radius > 0) {
      const Vec2<Real> lens = sample_disk(u_lens);
      const Vec3<Real> aside{lens.x * camera.lens_radius, lens.y * camera.lens_radius, 0};
      origin += aside;
      direction = direction * camera.focal_distance - aside;
    }
    return;
  }
  const bool equal_area = camera.kind == CameraKind::equal_area;
  Vec2<Real> at{x, y};
  if (equal_area) {
    // Filters reach past the edge, where the octahedral square continues rotated by half a turn.
    if (at.x < 0 || at.x > 1) at = {at.x < 0 ? -at.x : 2 - at.x, 1 - at.y};
    if (at.y < 0 || at.y > 1) at = {1 - at.x, at.y < 0 ? -at.y : 2 - at.y};
  }
  const Vec3<Real> d = direction_of_square(equal_area ? SphereMapping::octahedral : SphereMapping::equirectangular, at);
  direction = {d.x, d.z, d.y};
}

/// The ray through raster position `film` (in pixels; the centre of the first pixel is at 0.5, 0.5).
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Ray<Real> camera_ray(const CameraRecord<Real>& camera, const Vec2<Real>& film,
                                            const Vec2<Real>& u_lens, Real time) {
  Vec3<Real> origin{};
  Vec3<Real> direction{camera.x_scale * film.x + camera.x_offset, camera.y_scale * film.y + camera.y_offset, 1};
  if (camera.kind != CameraKind::perspective) {
    other_camera_ray(camera, film, u_lens, origin, direction);
  } else if (camera.lens_radius > 0) {
    const Vec2<Real> lens = sample_disk(u_lens);
    origin = {lens.x * camera.lens_radius, lens.y * camera.lens_radius, 0};
    direction = direction * camera.focal_distance - origin;
  }
  const auto row = [&](int i, const Vec3<Real>& v) {
    const Real* m = camera.world_from_camera[i];
    return m[0] * v.x + m[1] * v.y + m[2] * v.z;
  };
  const auto& m = camera.world_from_camera;
  return {{row(0, origin) + m[0][3], row(1, origin) + m[1][3], row(2, origin) + m[2][3]},
          normalize(Vec3<Real>{row(0, direction), row(1, direction), row(2, direction)}),
          time};
}

}  // namespace ALHAZEN_CORE

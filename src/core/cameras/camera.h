#pragma once

// The perspective camera with a thin lens.

#include "core/math/ray.h"
#include "core/math/vec.h"
#include "core/sampling/warp.h"

namespace ALHAZEN_CORE {

template <class Real>
struct CameraRecord {
  /// From raster (pixels, y down) to the plane z = 1 of camera space: x = x_scale * px + x_offset, and y likewise.
  Real x_scale, x_offset, y_scale, y_offset;
  Real lens_radius, focal_distance;
  Real world_from_camera[3][4];
};

/// The ray through raster position `film` (pixels; the first pixel's centre is at 0.5, 0.5).
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Ray<Real> camera_ray(const CameraRecord<Real>& camera, const Vec2<Real>& film,
                                            const Vec2<Real>& u_lens, Real time) {
  Vec3<Real> origin{};
  Vec3<Real> direction{camera.x_scale * film.x + camera.x_offset, camera.y_scale * film.y + camera.y_offset, 1};
  if (camera.lens_radius > 0) {
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

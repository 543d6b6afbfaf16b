#pragma once

// The sheared space of a ray in which triangles are tested (Woop, Benthin, Wald 2013).

#include "core/math/ray.h"
#include "core/math/scalar.h"

namespace ALHAZEN_CORE {

/// A ray prepared for the triangle test: the axes are permuted so that the direction is longest along the last one, and
/// the shear aligns the direction with that axis.
template <class Real>
struct ShearedRay {
  Vec3<Real> origin;  ///< along kx, ky and kz
  Vec3<Real> shear;
  int kx, ky, kz;
  PrimitiveId left;                      ///< Ray::left if it is in the ray's space, else none
  uint32_t checks_narrow_triangles = 0;  ///< SceneView::has_narrow_triangles
};

template <class Real>
ALHAZEN_HD ALHAZEN_HOT ShearedRay<Real> shear_ray(const Ray<Real>& ray, uint32_t checks_narrow_triangles) {
  ShearedRay<Real> s;
  s.checks_narrow_triangles = checks_narrow_triangles;
  s.kz = max_axis(abs(ray.direction));
  s.kx = s.kz == 2 ? 0 : s.kz + 1;
  s.ky = s.kx == 2 ? 0 : s.kx + 1;
  s.origin = {ray.origin[s.kx], ray.origin[s.ky], ray.origin[s.kz]};
  const Real inverse = Real(1) / ray.direction[s.kz];
  s.shear = {ray.direction[s.kx] * inverse, ray.direction[s.ky] * inverse, inverse};
  s.left = ray.left_instance == no_instance ? ray.left : PrimitiveId();
  return s;
}

}  // namespace ALHAZEN_CORE

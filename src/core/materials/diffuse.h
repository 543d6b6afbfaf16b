#pragma once

// Lambert's law: f = reflectance / pi, on the side from which it is seen.

#include "core/materials/sample.h"
#include "core/sampling/warp.h"

namespace ALHAZEN_CORE {

template <class Real>
struct DiffuseBsdf {
  Vec3<Real> reflectance;
};

template <class Real>
ALHAZEN_HD ALHAZEN_HOT BsdfSample<Real> sample_diffuse(const DiffuseBsdf<Real>& bsdf, const Vec3<Real>& wo,
                                                       const Vec2<Real>& u) {
  BsdfSample<Real> s;
  s.direction = sample_cosine_hemisphere(u);
  s.pdf = pdf_cosine_hemisphere(s.direction.z);
  s.weight = bsdf.reflectance;
  if (wo.z < 0) s.direction.z = -s.direction.z;
  return s;
}

template <class Real>
ALHAZEN_HD ALHAZEN_HOT BsdfValue<Real> evaluate_diffuse(const DiffuseBsdf<Real>& bsdf, const Vec3<Real>& wo,
                                                        const Vec3<Real>& wi) {
  if (!(wo.z * wi.z > 0)) return {};
  const Real pdf = pdf_cosine_hemisphere(std::abs(wi.z));
  return {bsdf.reflectance * pdf, pdf};
}

}  // namespace ALHAZEN_CORE

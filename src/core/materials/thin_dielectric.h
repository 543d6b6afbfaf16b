#pragma once

// Sheets without thickness: a clear pane, both of whose sides are met at once, and Lambert's law on both sides.

#include "core/materials/lobes/fresnel.h"
#include "core/materials/sample.h"
#include "core/sampling/warp.h"

namespace ALHAZEN_CORE {

/// Reflection from both sides and everything between them: R + T^2 R / (1 - R^2).
template <class Real>
ALHAZEN_HD BsdfSample<Real> sample_thin_dielectric(Real ior, const Vec3<Real>& wo, Real u_lobe) {
  BsdfSample<Real> s;
  if (wo.z == 0) return s;
  Real cos_t;
  const Real once = fresnel_dielectric(std::abs(wo.z), ior, cos_t);
  const Real reflected = once < 1 ? once + sqr(1 - once) * once / (1 - once * once) : Real(1);
  s.specular = true;
  s.weight = splat(Real(1));
  if (u_lobe < reflected) {
    s.direction = {-wo.x, -wo.y, wo.z};
    s.pdf = reflected;
  } else {
    s.direction = -wo;
    s.pdf = 1 - reflected;
  }
  return s;
}

template <class Real>
struct DiffuseTransmissionBsdf {
  Vec3<Real> reflectance, transmittance;

  ALHAZEN_HD Real reflection_rate() const {
    const Real r = max_component(reflectance), t = max_component(transmittance);
    return r + t > 0 ? r / (r + t) : Real(1);
  }
};

template <class Real>
ALHAZEN_HD BsdfSample<Real> sample_diffuse_transmission(const DiffuseTransmissionBsdf<Real>& bsdf, const Vec3<Real>& wo,
                                                        Real u_lobe, const Vec2<Real>& u) {
  BsdfSample<Real> s;
  const Real rate = bsdf.reflection_rate();
  const bool reflects = u_lobe < rate;
  const Real share = reflects ? rate : 1 - rate;
  if (!(share > 0)) return s;
  s.direction = sample_cosine_hemisphere(u);
  s.pdf = pdf_cosine_hemisphere(s.direction.z) * share;
  s.weight = (reflects ? bsdf.reflectance : bsdf.transmittance) / share;
  if ((wo.z < 0) == reflects) s.direction.z = -s.direction.z;
  return s;
}

template <class Real>
ALHAZEN_HD BsdfValue<Real> evaluate_diffuse_transmission(const DiffuseTransmissionBsdf<Real>& bsdf,
                                                         const Vec3<Real>& wo, const Vec3<Real>& wi) {
  if (wo.z * wi.z == 0) return {};
  const bool reflects = wo.z * wi.z > 0;
  const Real pdf = pdf_cosine_hemisphere(std::abs(wi.z)), rate = bsdf.reflection_rate();
  return {(reflects ? bsdf.reflectance : bsdf.transmittance) * pdf, pdf * (reflects ? rate : 1 - rate)};
}

}  // namespace ALHAZEN_CORE

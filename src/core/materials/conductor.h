#pragma once

// Metal: Fresnel reflection from a smooth surface or from GGX microfacets (single scattering).

#include "core/materials/lobes/fresnel.h"
#include "core/materials/lobes/microfacet.h"
#include "core/materials/sample.h"

namespace ALHAZEN_CORE {

template <class Real, class Alpha = Real>
struct ConductorBsdf {
  Vec3<Real> eta, k;
  Alpha alpha;  ///< below smooth_alpha: a mirror
};

template <class Real, class Alpha>
ALHAZEN_HD BsdfSample<Real> sample_conductor(const ConductorBsdf<Real, Alpha>& bsdf, const Vec3<Real>& wo,
                                             const Vec2<Real>& u) {
  BsdfSample<Real> s;
  if (wo.z == 0) return s;
  if (is_smooth(bsdf.alpha)) {
    s.direction = {-wo.x, -wo.y, wo.z};
    s.weight = fresnel_conductor(std::abs(wo.z), bsdf.eta, bsdf.k);
    s.pdf = 1;
    s.specular = true;
    return s;
  }
  const Real side = wo.z < 0 ? Real(-1) : Real(1);
  const Vec3<Real> o = wo * side;
  const Vec3<Real> m = sample_visible_normal(o, bsdf.alpha, u);
  const Real cos_om = dot(o, m);
  const Vec3<Real> i = m * (2 * cos_om) - o;
  if (!(i.z > 0 && cos_om > 0)) return s;
  s.direction = i * side;
  s.pdf = pdf_visible_normal(o, m, bsdf.alpha) / (4 * cos_om);
  s.weight = fresnel_conductor(cos_om, bsdf.eta, bsdf.k) * (ggx_g2(o, i, bsdf.alpha) / ggx_g1(o, bsdf.alpha));
  return s;
}

template <class Real, class Alpha>
ALHAZEN_HD BsdfValue<Real> evaluate_conductor(const ConductorBsdf<Real, Alpha>& bsdf, const Vec3<Real>& wo,
                                              const Vec3<Real>& wi) {
  if (is_smooth(bsdf.alpha) || !(wo.z * wi.z > 0)) return {};
  const Real side = wo.z < 0 ? Real(-1) : Real(1);
  const Vec3<Real> o = wo * side, i = wi * side;
  const Vec3<Real> half = o + i;
  if (is_zero(half)) return {};
  const Vec3<Real> m = normalize(half);
  const Real cos_om = dot(o, m);
  if (!(cos_om > 0)) return {};
  const Real d = ggx_d(m, bsdf.alpha);
  const Vec3<Real> f = fresnel_conductor(cos_om, bsdf.eta, bsdf.k);
  return {f * (d * ggx_g2(o, i, bsdf.alpha) / (4 * o.z)), ggx_g1(o, bsdf.alpha) * d / (4 * o.z)};
}

}  // namespace ALHAZEN_CORE

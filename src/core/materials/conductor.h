#pragma once

// Conductors: Fresnel reflection from a smooth surface or from GGX microfacets (single scattering). Anisotropic
// conductors are a kind of their own, so that the frequent, isotropic kind stays small.

#include "core/materials/closure.h"
#include "core/materials/lobes/fresnel.h"
#include "core/materials/lobes/metal.h"
#include "core/materials/lobes/microfacet.h"

namespace ALHAZEN_CORE {

ALHAZEN_HD constexpr MaterialTraits conductor_traits() {
  return {.has_lobes = false, .is_one_sided = true, .is_bare_metal = true};
}
ALHAZEN_HD constexpr MaterialTraits anisotropic_conductor_traits() { return conductor_traits(); }

template <class Real>
struct ConductorRecord {
  MetalRecord metal;
  TextureRange roughness;    ///< scalar; absent: smooth
  uint32_t remap_roughness;  ///< 1: alpha = sqrt(roughness)
};

template <class Real>
struct AnisotropicConductorRecord {
  MetalRecord metal;
  TextureRange roughness_u, roughness_v;  ///< scalars, along the tangent and the bitangent
  uint32_t remap_roughness;               ///< 1: alpha = sqrt(roughness)
};

template <class Real, AlphaOf<Real> Alpha = Real>
struct ConductorBsdf {
  Vec3<Real> eta, k;
  Alpha alpha;  ///< below smooth_alpha: perfectly specular

  ALHAZEN_HD BsdfSample<Real> sample(const Vec3<Real>& wo, Real, const Vec2<Real>& u) const {
    BsdfSample<Real> s;
    if (wo.z == 0) return s;
    if (is_smooth(alpha)) {
      s.direction = {-wo.x, -wo.y, wo.z};
      s.weight = fresnel_conductor(std::abs(wo.z), eta, k);
      s.pdf = 1;
      s.specular = true;
      return s;
    }
    const Real side = wo.z < 0 ? Real(-1) : Real(1);
    const Vec3<Real> o = wo * side;
    const Vec3<Real> m = sample_reflecting_normal(o, alpha, u);
    const Real cos_om = dot(o, m);
    const Vec3<Real> i = m * (2 * cos_om) - o;
    if (!(i.z > 0 && cos_om > 0)) return s;
    const Real density = ggx_reflection_density(o, alpha);
    s.direction = i * side;
    s.pdf = density * ggx_d(m, alpha);
    s.weight = fresnel_conductor(cos_om, eta, k) * (ggx_g2(o, i, alpha) / (4 * o.z * density));
    return s;
  }

  ALHAZEN_HD BsdfValue<Real> evaluate(const Vec3<Real>& wo, const Vec3<Real>& wi) const {
    if (is_smooth(alpha) || !(wo.z * wi.z > 0)) return {};
    const Real side = wo.z < 0 ? Real(-1) : Real(1);
    const Vec3<Real> o = wo * side, i = wi * side;
    const Vec3<Real> half = o + i;
    if (is_zero(half)) return {};
    const Vec3<Real> m = normalize(half);
    const Real cos_om = dot(o, m);
    if (!(cos_om > 0)) return {};
    const Real d = ggx_d(m, alpha);
    const Vec3<Real> f = fresnel_conductor(cos_om, eta, k);
    return {f * (d * ggx_g2(o, i, alpha) / (4 * o.z)), d * ggx_reflection_density(o, alpha)};
  }

  ALHAZEN_HD Vec3<Real> albedo() const { return fresnel_conductor(Real(1), eta, k); }
  ALHAZEN_HD constexpr bool is_specular() const { return is_smooth(alpha); }
};

template <class Real>
using AnisotropicConductorBsdf = ConductorBsdf<Real, Vec2<Real>>;

template <class Real, TexturesOf<Real> Textures>
ALHAZEN_HD ALHAZEN_HOT void make_closure(const ConductorRecord<Real>& record, const Textures& textures,
                                         ConductorBsdf<Real>& bsdf) {
  bsdf.alpha = textures.alpha(record.roughness, record.remap_roughness);
  set_metal(record.metal, textures, bsdf.eta, bsdf.k);
}

template <class Real, TexturesOf<Real> Textures>
ALHAZEN_HD void make_closure(const AnisotropicConductorRecord<Real>& record, const Textures& textures,
                             const ClosureView<Real>&, AnisotropicConductorBsdf<Real>& bsdf) {
  bsdf.alpha = rough_alphas<Real>(textures.alpha(record.roughness_u, record.remap_roughness),
                                  textures.alpha(record.roughness_v, record.remap_roughness));
  set_metal(record.metal, textures, bsdf.eta, bsdf.k);
}

}  // namespace ALHAZEN_CORE

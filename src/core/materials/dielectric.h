#pragma once

// Glass and other dielectrics: reflection and refraction at a smooth interface or at GGX microfacets (Walter et al.
// 2007), with compensation for multiple scattering (core/materials/lobes/glass_albedo.h). Refraction scales radiance by
// 1 / eta^2, as paths from the camera require. Anisotropic dielectrics are a kind of their own, so that the frequent,
// isotropic kind stays small.

#include "core/materials/closure.h"
#include "core/materials/lobes/fresnel.h"
#include "core/materials/lobes/glass_albedo.h"
#include "core/materials/lobes/microfacet.h"
#include "core/textures/texture_record.h"

namespace ALHAZEN_CORE {

ALHAZEN_HD constexpr MaterialTraits dielectric_traits() { return {}; }
ALHAZEN_HD constexpr MaterialTraits anisotropic_dielectric_traits() { return {}; }

template <class Real>
struct DielectricRecord {
  Real ior;                  ///< inside relative to outside
  TextureRange roughness;    ///< scalar; absent: smooth
  uint32_t remap_roughness;  ///< 1: alpha = sqrt(roughness)
  AlbedoGridRecord grid;     ///< GlassGrid; no quantities if it is smooth everywhere
};

template <class Real>
struct AnisotropicDielectricRecord {
  Real ior;
  TextureRange roughness_u, roughness_v;  ///< scalars, along the tangent and the bitangent
  uint32_t remap_roughness;               ///< 1: alpha = sqrt(roughness)
  AlbedoGridRecord grid;                  ///< GlassGrid
};

template <class Real, AlphaOf<Real> Alpha = Real>
struct DielectricBsdf {
  Real ior;                      ///< inside (against the normal) relative to outside
  Alpha alpha;                   ///< below smooth_alpha: a smooth interface
  AlbedoGridPlace<Real> grid{};  ///< GlassGrid; without a block, there is only single scattering

  ALHAZEN_HD BsdfSample<Real> sample(const Vec3<Real>& wo, Real u_lobe, const Vec2<Real>& u) const;
  ALHAZEN_HD BsdfValue<Real> evaluate(const Vec3<Real>& wo, const Vec3<Real>& wi) const;
  ALHAZEN_HD Vec3<Real> albedo() const { return splat(Real(1)); }
  ALHAZEN_HD constexpr bool is_specular() const { return is_smooth(alpha) || ior == 1; }
  /// Returns whether multiple scattering is compensated.
  ALHAZEN_HD constexpr bool is_compensated() const { return grid.block != nullptr; }
};

template <class Real>
using AnisotropicDielectricBsdf = DielectricBsdf<Real, Vec2<Real>>;

template <class Real, TexturesOf<Real> Textures>
ALHAZEN_HD ALHAZEN_HOT void make_closure(const DielectricRecord<Real>& record, const Textures& textures,
                                         DielectricBsdf<Real>& bsdf) {
  bsdf.ior = record.ior;
  bsdf.alpha = textures.alpha(record.roughness, record.remap_roughness);
  bsdf.grid = {};
  if (record.grid.quantities > 0 && !bsdf.is_specular())
    bsdf.grid = textures.grid(record.grid, Vec2<Real>{bsdf.alpha, bsdf.alpha});
}

template <class Real, TexturesOf<Real> Textures>
ALHAZEN_HD void make_closure(const AnisotropicDielectricRecord<Real>& record, const Textures& textures,
                             const ClosureView<Real>&, AnisotropicDielectricBsdf<Real>& bsdf) {
  bsdf.ior = record.ior;
  bsdf.alpha = rough_alphas<Real>(textures.alpha(record.roughness_u, record.remap_roughness),
                                  textures.alpha(record.roughness_v, record.remap_roughness));
  bsdf.grid = {};
  if (record.grid.quantities > 0) bsdf.grid = textures.grid(record.grid, bsdf.alpha);
}

/// The reflected and the refracted direction at a microfacet whose normal is sampled by `u`, for single scattering.
/// Their weights and densities exclude the Fresnel reflectance: the outgoing radiance is
/// rate * L(reflected) * weight + (1 - rate) * L(refracted) * weight.
template <class Real>
struct DielectricBranches {
  BsdfSample<Real> reflected, refracted;  ///< pdf 0: there is no such direction
  Real reflected_rate = 1;
};

template <class Real, AlphaOf<Real> Alpha>
ALHAZEN_HD DielectricBranches<Real> dielectric_branches(const DielectricBsdf<Real, Alpha>& bsdf, const Vec3<Real>& wo,
                                                        const Vec2<Real>& u) {
  DielectricBranches<Real> branches;
  if (wo.z == 0) return branches;
  // Work on the side of wo, with z > 0 there; eta is the index of the other side relative to this one.
  const Real side = wo.z < 0 ? Real(-1) : Real(1);
  const Real eta = wo.z < 0 ? 1 / bsdf.ior : bsdf.ior;
  const Vec3<Real> o = wo * side;
  const bool smooth = is_smooth(bsdf.alpha) || bsdf.ior == 1;
  const Vec3<Real> m = smooth ? Vec3<Real>{0, 0, 1} : sample_visible_normal(o, bsdf.alpha, u);
  const Real cos_o = smooth ? o.z : dot(o, m);
  if (!(cos_o > 0)) return branches;
  Real cos_t;
  const Real rate = fresnel_dielectric(cos_o, eta, cos_t);
  branches.reflected_rate = rate;
  const Real density = smooth ? Real(1) : pdf_visible_normal(o, m, bsdf.alpha);
  const Real g1 = smooth ? Real(1) : ggx_g1(o, bsdf.alpha);

  BsdfSample<Real>& r = branches.reflected;
  const Vec3<Real> mirrored = m * (2 * cos_o) - o;
  if (rate > 0 && mirrored.z > 0) {
    r.direction = mirrored * side;
    r.weight = splat(smooth ? Real(1) : ggx_g2(o, mirrored, bsdf.alpha) / g1);
    r.pdf = smooth ? Real(1) : density / (4 * cos_o);
    r.specular = smooth;
  }
  BsdfSample<Real>& t = branches.refracted;
  const Vec3<Real> bent = m * (cos_o / eta - cos_t) - o * (1 / eta);
  if (rate < 1 && bent.z < 0) {
    t.direction = normalize(bent) * side;
    t.weight = splat((smooth ? Real(1) : ggx_g2(o, bent, bsdf.alpha) / g1) / (eta * eta));
    t.pdf = smooth ? Real(1) : density * cos_t / sqr(cos_o / eta - cos_t);
    t.eta = eta;
    t.specular = smooth;
  }
  return branches;
}

/// The microfacet that reflects or refracts `wo` into `wi`.
template <class Real>
struct DielectricFacet {
  Real eta;           ///< index of the other side relative to that of wo
  Real cos_o, cos_i;  ///< to the microfacet normal, which is on the side of wo
  Real cos_n;         ///< between wo and the shading normal, > 0
  Real rate;          ///< Fresnel reflectance
  Real d, g2;
  Real density;  ///< of sampling the microfacet normal
  bool reflects;
  bool total;  ///< total internal reflection
};

/// Returns false if there is no such microfacet.
template <class Real, AlphaOf<Real> Alpha>
ALHAZEN_HD ALHAZEN_HOT bool dielectric_facet(const DielectricBsdf<Real, Alpha>& bsdf, const Vec3<Real>& wo,
                                             const Vec3<Real>& wi, DielectricFacet<Real>& facet) {
  const Real side = wo.z < 0 ? Real(-1) : Real(1);
  const Real eta = wo.z < 0 ? 1 / bsdf.ior : bsdf.ior;
  const Vec3<Real> o = wo * side, i = wi * side;
  const bool reflect = i.z > 0;
  const Vec3<Real> half = reflect ? o + i : o + i * eta;
  if (is_zero(half)) return false;
  Vec3<Real> m = normalize(half);
  if (m.z < 0) m = -m;
  const Real cos_o = dot(o, m), cos_i = dot(i, m);
  if (!(cos_o > 0) || (reflect ? !(cos_i > 0) : !(cos_i < 0))) return false;
  // Refraction uses both known cosines: near the critical angle, Snell's law would lose the precision of one of them.
  Real cos_t = 1;
  facet.rate = reflect ? fresnel_dielectric(cos_o, eta, cos_t) : fresnel_of_cosines(cos_o, -cos_i, eta);
  facet.total = !(cos_t > 0);
  facet.d = ggx_d(m, bsdf.alpha), facet.g2 = ggx_g2(o, i, bsdf.alpha);
  facet.density = ggx_g1(o, bsdf.alpha) * facet.d * cos_o / o.z;
  facet.eta = eta, facet.cos_o = cos_o, facet.cos_i = cos_i, facet.cos_n = o.z, facet.reflects = reflect;
  return true;
}

/// Evaluates single scattering without compensation.
template <class Real, AlphaOf<Real> Alpha>
ALHAZEN_HD ALHAZEN_HOT BsdfValue<Real> evaluate_single_scattering(const DielectricBsdf<Real, Alpha>& bsdf,
                                                                  const Vec3<Real>& wo, const Vec3<Real>& wi) {
  DielectricFacet<Real> f;
  if (!dielectric_facet(bsdf, wo, wi, f)) return {};
  if (f.reflects) return {splat(f.rate * f.d * f.g2 / (4 * f.cos_n)), f.rate * f.density / (4 * f.cos_o)};
  const Real jacobian = -f.cos_i / sqr(f.cos_i + f.cos_o / f.eta);
  return {splat((1 - f.rate) * f.d * f.g2 * jacobian * f.cos_o / (f.cos_n * f.eta * f.eta)),
          (1 - f.rate) * f.density * jacobian};
}

/// Adds compensation to single scattering, of which `v` has the value and the density.
template <class Real, AlphaOf<Real> Alpha>
ALHAZEN_HD void compensate(const DielectricBsdf<Real, Alpha>& bsdf, const Vec3<Real>& wo, const GlassAlbedo<Real>& o,
                           const Vec3<Real>& wi, BsdfValue<Real>& v) {
  const GlassAlbedo<Real> i = glass_albedo(bsdf.grid, bsdf.ior, wi);
  const GlassMultiple<Real> multiple =
      evaluate_glass_lobe(glass_lobe(bsdf.grid, bsdf.ior, wo.z < 0), o, i, wi.z, wo.z * wi.z > 0);
  v.value = v.value * single_scattering_scale(o, i) + splat(multiple.value);
  v.pdf = v.pdf * (1 - o.missing) + multiple.pdf;
}

template <class Real, AlphaOf<Real> Alpha>
ALHAZEN_HD BsdfValue<Real> DielectricBsdf<Real, Alpha>::evaluate(const Vec3<Real>& wo, const Vec3<Real>& wi) const {
  if (is_specular() || wo.z == 0 || wi.z == 0) return {};
  BsdfValue<Real> v = evaluate_single_scattering(*this, wo, wi);
  if (is_compensated()) compensate(*this, wo, glass_albedo(grid, ior, wo), wi, v);
  return v;
}

/// Samples one of the two directions of single scattering; the probability of reflection is the Fresnel reflectance.
template <class Real, AlphaOf<Real> Alpha>
ALHAZEN_HD BsdfSample<Real> sample_single_scattering(const DielectricBsdf<Real, Alpha>& bsdf, const Vec3<Real>& wo,
                                                     Real u_lobe, const Vec2<Real>& u) {
  const DielectricBranches<Real> branches = dielectric_branches(bsdf, wo, u);
  const bool reflect = u_lobe < branches.reflected_rate;
  BsdfSample<Real> s = reflect ? branches.reflected : branches.refracted;
  s.pdf *= reflect ? branches.reflected_rate : 1 - branches.reflected_rate;
  return s;
}

template <class Real, AlphaOf<Real> Alpha>
ALHAZEN_HD BsdfSample<Real> DielectricBsdf<Real, Alpha>::sample(const Vec3<Real>& wo, Real u_lobe,
                                                                const Vec2<Real>& u) const {
  if (!is_compensated() || wo.z == 0) return sample_single_scattering(*this, wo, u_lobe, u);
  const GlassAlbedo<Real> o = glass_albedo(grid, ior, wo);
  const Real single = 1 - o.missing;
  if (u_lobe < single) {
    BsdfSample<Real> s = sample_single_scattering(*this, wo, min(u_lobe / single, one_minus_epsilon<Real>), u);
    if (!(s.pdf > 0)) return s;
    // Value and density are those of the sampled microfacet, which near an index of 1 is lost in the directions.
    BsdfValue<Real> v{s.weight * s.pdf, s.pdf};
    compensate(*this, wo, o, s.direction, v);
    s.weight = v.value / v.pdf;
    s.pdf = v.pdf;
    return s;
  }
  const Vec3<Real> wi = sample_glass_lobe(glass_lobe(grid, ior, wo.z < 0), wo, (u_lobe - single) / o.missing, u);
  if (wi.z == 0) return {};
  BsdfValue<Real> v = evaluate_single_scattering(*this, wo, wi);
  compensate(*this, wo, o, wi, v);
  BsdfSample<Real> s;
  if (!(v.pdf > 0)) return s;
  s.direction = wi;
  s.weight = v.value / v.pdf;
  s.pdf = v.pdf;
  if (wo.z * wi.z < 0) s.eta = wo.z < 0 ? 1 / ior : ior;
  return s;
}

}  // namespace ALHAZEN_CORE

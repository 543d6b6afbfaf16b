#pragma once

// Glass and other dielectrics: reflection and refraction at a smooth interface or at GGX microfacets (Walter et al.
// 2007), with another term of shadowing and masking and a lobe of multiple scattering, so that no light is lost
// (core/materials/lobes/glass_albedo.h). Refraction scales radiance by 1 / eta^2, as paths from the camera require.
// Anisotropic dielectrics are a kind of their own, so that the frequent, isotropic kind stays small.

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

/// The reflected and the refracted direction at a microfacet whose normal is sampled by `u`, for single scattering with
/// the height-correlated term of shadowing and masking of Smith. Their weights and densities exclude the Fresnel
/// reflectance: the outgoing radiance is rate * L(reflected) * weight + (1 - rate) * L(refracted) * weight.
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
  Real cos_o = 1, cos_i = 1;  ///< to the microfacet normal, which is on the side of wo
  Real eta = 1;               ///< index of the other side relative to that of wo
  Real rate = 1;              ///< Fresnel reflectance
  Real density = 0;           ///< of sampling the microfacet normal, and of keeping it
  bool reflects = true;
  bool total = false;  ///< total internal reflection
};

/// Returns the density with respect to solid angle of sampling `wi`, if reflection has the probability `rate`.
template <class Real>
ALHAZEN_HD Real scattering_density(const DielectricFacet<Real>& f, Real rate) {
  if (f.reflects) return rate * f.density / (4 * f.cos_o);
  return (1 - rate) * f.density * -f.cos_i / sqr(f.cos_i + f.cos_o / f.eta);
}

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
  facet.density = min(ggx_g1(o, bsdf.alpha), ggx_g1(i, bsdf.alpha)) * ggx_d(m, bsdf.alpha) * cos_o / o.z;
  facet.eta = eta, facet.cos_o = cos_o, facet.cos_i = cos_i, facet.reflects = reflect;
  return true;
}

/// Samples a microfacet visible from `wo`, whether it reflects or refracts, with the probability
/// reflection_rate(Fresnel reflectance, whether reflection is total), and whether it is kept. Returns the
/// direction, or zero if it is not kept; then `u_lobe` becomes a uniform number that is independent of all this.
template <class Real, AlphaOf<Real> Alpha, class ReflectionRate>
ALHAZEN_HD Vec3<Real> sample_dielectric_facet(const DielectricBsdf<Real, Alpha>& bsdf, const Vec3<Real>& wo,
                                              const ReflectionRate& reflection_rate, Real& u_lobe, const Vec2<Real>& u,
                                              DielectricFacet<Real>& facet) {
  const Real side = wo.z < 0 ? Real(-1) : Real(1);
  const Real eta = wo.z < 0 ? 1 / bsdf.ior : bsdf.ior;
  const Vec3<Real> o = wo * side, m = sample_visible_normal(o, bsdf.alpha, u);
  facet.eta = eta, facet.cos_o = dot(o, m);
  if (!(facet.cos_o > 0)) return {};
  Real cos_t;
  facet.rate = fresnel_dielectric(facet.cos_o, eta, cos_t);
  facet.total = !(cos_t > 0);
  const Real rate = reflection_rate(facet.rate, facet.total);
  facet.reflects = u_lobe < rate;
  u_lobe = min(facet.reflects ? u_lobe / rate : (u_lobe - rate) / (1 - rate), one_minus_epsilon<Real>);
  facet.cos_i = facet.reflects ? facet.cos_o : -cos_t;
  const Vec3<Real> i =
      facet.reflects ? m * (2 * facet.cos_o) - o : normalize(m * (facet.cos_o / eta - cos_t) - o * (1 / eta));
  if (facet.reflects ? !(i.z > 0) : !(i.z < 0)) return {};
  const Real g1 = ggx_g1(o, bsdf.alpha), visible = min(g1, ggx_g1(i, bsdf.alpha)), kept = visible / g1;
  facet.density = visible * ggx_d(m, bsdf.alpha) * facet.cos_o / o.z;
  if (u_lobe < kept) return i * side;
  u_lobe = (u_lobe - kept) / (1 - kept);
  return {};
}

/// Value and density of scattering at a rough surface; `single` is the density of single scattering. `missing` is the
/// fraction that single scattering loses.
template <class Real, AlphaOf<Real> Alpha>
ALHAZEN_HD BsdfValue<Real> with_multiple_scattering(const DielectricBsdf<Real, Alpha>& bsdf, Real single, Real missing,
                                                    const Vec3<Real>& wo, const Vec3<Real>& wi) {
  GlassMultiple<Real> multiple{0, 0};
  const bool reflects = wo.z * wi.z > 0;
  if (bsdf.is_compensated())
    multiple = evaluate_glass_lobe(bsdf.grid, bsdf.ior, glass_lobe(bsdf.grid, bsdf.ior, wo.z < 0), wi, reflects);
  const Real scale = reflects ? Real(1) : 1 / sqr(index_beyond(bsdf.ior, wo.z < 0));
  return {splat((single + missing * multiple.value) * scale), single + missing * multiple.pdf};
}

/// Returns the fraction of light from `wo` that single scattering loses.
template <class Real, AlphaOf<Real> Alpha>
ALHAZEN_HD Real missing_of(const DielectricBsdf<Real, Alpha>& bsdf, const Vec3<Real>& wo) {
  return bsdf.is_compensated() ? glass_missing(bsdf.grid, glass_direction(bsdf.grid, bsdf.ior, wo)) : Real(0);
}

template <class Real, AlphaOf<Real> Alpha>
ALHAZEN_HD BsdfValue<Real> DielectricBsdf<Real, Alpha>::evaluate(const Vec3<Real>& wo, const Vec3<Real>& wi) const {
  if (is_specular() || wo.z == 0 || wi.z == 0) return {};
  DielectricFacet<Real> f;
  const Real single = dielectric_facet(*this, wo, wi, f) ? scattering_density(f, f.rate) : Real(0);
  return with_multiple_scattering(*this, single, missing_of(*this, wo), wo, wi);
}

/// Samples one of the two directions at a smooth surface; the probability of reflection is the Fresnel reflectance.
template <class Real>
ALHAZEN_HD BsdfSample<Real> sample_smooth_dielectric(Real ior, const Vec3<Real>& wo, Real u_lobe) {
  BsdfSample<Real> s;
  const Real side = wo.z < 0 ? Real(-1) : Real(1), eta = index_beyond(ior, wo.z < 0);
  const Vec3<Real> o = wo * side;
  Real cos_t;
  const Real rate = fresnel_dielectric(o.z, eta, cos_t);
  s.specular = 1;
  if (u_lobe < rate) {
    s.direction = {-wo.x, -wo.y, wo.z};
    s.weight = splat(Real(1));
    s.pdf = rate;
    return s;
  }
  const Vec3<Real> bent = Vec3<Real>{0, 0, o.z / eta - cos_t} - o * (1 / eta);
  if (!(bent.z < 0)) return {};
  s.direction = normalize(bent) * side;
  s.weight = splat(1 / (eta * eta));
  s.pdf = 1 - rate;
  s.eta = eta;
  return s;
}

template <class Real, AlphaOf<Real> Alpha>
ALHAZEN_HD BsdfSample<Real> DielectricBsdf<Real, Alpha>::sample(const Vec3<Real>& wo, Real u_lobe,
                                                                const Vec2<Real>& u) const {
  if (wo.z == 0) return {};
  if (is_specular()) return sample_smooth_dielectric(ior, wo, u_lobe);
  BsdfSample<Real> s;
  DielectricFacet<Real> f;
  s.direction = sample_dielectric_facet(
      *this, wo, [](Real fresnel, bool) { return fresnel; }, u_lobe, u, f);
  // Near an index of 1 the directions do not determine the microfacet precisely, so that which was sampled is used.
  Real single = 0;
  if (!is_zero(s.direction)) {
    single = scattering_density(f, f.rate);
  } else {
    if (!is_compensated()) return {};
    s.direction = sample_glass_lobe(grid, ior, wo, u_lobe, further_numbers(u));
    if (s.direction.z == 0) return {};
    if (dielectric_facet(*this, wo, s.direction, f)) single = scattering_density(f, f.rate);
  }
  const BsdfValue<Real> v = with_multiple_scattering(*this, single, missing_of(*this, wo), wo, s.direction);
  if (!(v.pdf > 0)) return {};
  s.weight = v.value / v.pdf;
  s.pdf = v.pdf;
  if (wo.z * s.direction.z < 0) s.eta = index_beyond(ior, wo.z < 0);
  return s;
}

}  // namespace ALHAZEN_CORE

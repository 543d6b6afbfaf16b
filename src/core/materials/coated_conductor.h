#pragma once

// pbrt's coated conductor: a rough dielectric interface over metal, without a random walk between the two. Light that
// the interface transmits leaves in one lobe (core/materials/lobes/coated_metal.h), wider than that of the bare metal.

#include "core/materials/closure.h"
#include "core/materials/lobes/coated_metal.h"
#include "core/materials/lobes/ggx_albedo.h"
#include "core/materials/lobes/metal.h"
#include "core/materials/lobes/microfacet.h"

namespace ALHAZEN_CORE {

ALHAZEN_HD constexpr MaterialTraits coated_conductor_traits() { return {.is_one_sided = true}; }

template <class Real>
struct CoatedConductorRecord {
  MetalRecord metal;
  TextureRange roughness_u, roughness_v;  ///< scalars, of the metal; v absent: same as u; u absent: smooth
  TextureRange coat_roughness;            ///< scalar; absent: smooth
  uint32_t remap_roughness;               ///< 1: alpha = sqrt(roughness)
  uint32_t is_anisotropic;                ///< the alphas of the metal may differ
  Real coat_ior;
  uint32_t coat_albedo;                ///< offset of the interface's table in SceneView::albedo_tables
  uint32_t coated_metal;               ///< offset of the table of core/materials/lobes/coated_metal.h
  uint32_t coat_varies, metal_varies;  ///< 1: that table has a dimension for this roughness
  AlbedoGridRecord grid;               ///< GgxGrid of the metal lobe
  AlbedoGridRecord mean_grid;          ///< if `is_anisotropic`: GgxGrid of the lobe's mean alpha
};

template <class Real>
struct CoatedConductorBsdf {
  Real coat_alpha, coat_ior;
  const Real* coat_albedo;
  Vec3<Real> coat_normal;      ///< local
  Vec2<Real> alpha;            ///< of the metal lobe
  Vec3<Real> eta, k;           ///< of the metal relative to the coat
  AlbedoGridPlace<Real> grid;  ///< GgxGrid of `alpha`
  CoatedMetalPlace<Real> coated_metal;
  bool is_anisotropic;              ///< the alphas may differ; `coated_metal` is tabulated for their mean
  AlbedoGridPlace<Real> mean_grid;  ///< if anisotropic: GgxGrid of the mean alpha

  ALHAZEN_HD BsdfSample<Real> sample(const Vec3<Real>& wo, Real u_lobe, const Vec2<Real>& u) const;
  ALHAZEN_HD ALHAZEN_COLD BsdfValue<Real> evaluate(const Vec3<Real>& wo, const Vec3<Real>& wi) const;
  ALHAZEN_HD Vec3<Real> albedo() const;
  ALHAZEN_HD constexpr bool is_specular() const { return false; }
};

/// Clamps an index or absorption coefficient so that its fourth power is finite.
template <class Real>
ALHAZEN_HD Vec3<Real> bounded_index(const Vec3<Real>& index) {
  return min(max(index, Vec3<Real>{}), splat(Real(1e8)));
}

template <class Real, TexturesOf<Real> Textures>
ALHAZEN_HD ALHAZEN_COLD void make_closure(const CoatedConductorRecord<Real>& record, const Textures& textures,
                                          const ClosureView<Real>& view, CoatedConductorBsdf<Real>& b) {
  b.coat_ior = record.coat_ior;
  b.coat_albedo = textures.table(record.coat_albedo);
  b.coat_normal = view.coat_normal;
  b.coat_alpha = layered_alpha(textures.alpha(record.coat_roughness, record.remap_roughness));
  const Vec2<Real> bare = textures.layered_alphas(record.roughness_u, record.roughness_v, record.remap_roughness);
  const Real mean = mean_alpha(bare);
  b.coated_metal = coated_metal_place(textures.table(record.coated_metal), record.coat_varies != 0,
                                      record.metal_varies != 0, b.coat_alpha, mean, b.coat_ior);
  b.alpha = {coated_metal_alpha(b.coat_alpha, bare.x, b.coat_ior),
             coated_metal_alpha(b.coat_alpha, bare.y, b.coat_ior)};
  b.grid = textures.grid(record.grid, b.alpha);
  b.is_anisotropic = record.is_anisotropic != 0;
  if (b.is_anisotropic) {
    const Real alpha = coated_metal_alpha(b.coat_alpha, mean, b.coat_ior);
    b.mean_grid = textures.grid(record.mean_grid, Vec2<Real>{alpha, alpha});
  }
  set_metal(record.metal, textures, b.eta, b.k);
  b.eta = bounded_index(b.eta / b.coat_ior), b.k = bounded_index(b.k / b.coat_ior);
}

/// Returns the Fresnel reflectance of the metal for a cosine outside the coat.
template <class Real>
ALHAZEN_HD Vec3<Real> fresnel_of_metal(const CoatedConductorBsdf<Real>& b, Real cosine) {
  const Real cosine_within = safe_sqrt(1 - (1 - cosine * cosine) / (b.coat_ior * b.coat_ior));
  return fresnel_conductor(cosine_within, b.eta, b.k);
}

template <class Real>
ALHAZEN_HD Vec3<Real> CoatedConductorBsdf<Real>::albedo() const {
  return min(max(fresnel_of_metal(*this, Real(1)), Vec3<Real>{}), splat(Real(1)));
}

/// Terms that depend only on the outgoing direction.
template <class Real>
struct CoatedConductorLobes {
  Real coat = 0, metal = 0;  ///< sampling probabilities
  CoatedMetalFactors<Real> factors{1, 1};
};

/// Returns the factors on the metal lobe. They are tabulated for a single alpha, so for anisotropic metal they are
/// scaled by the ratio of the albedos.
template <class Real>
ALHAZEN_HD CoatedMetalFactors<Real> lobe_factors(const CoatedConductorBsdf<Real>& b, Real lobe_albedo,
                                                 const Vec3<Real>& o) {
  CoatedMetalFactors<Real> factors = coated_metal_factors(b.coated_metal, o.z);
  if (!b.is_anisotropic) return factors;
  const Real scale = ggx_albedo(b.mean_grid, o).all() / max(Real(0.01), lobe_albedo);
  return {factors.once * scale, factors.all * scale};
}

template <class Real>
ALHAZEN_HD ALHAZEN_COLD CoatedConductorLobes<Real> lobes_of(const CoatedConductorBsdf<Real>& b, const Vec3<Real>& o,
                                                            Real coat_cosine) {
  CoatedConductorLobes<Real> lobes;
  if (coat_cosine > 0) lobes.coat = lookup_albedo(b.coat_albedo, coat_cosine, b.coat_alpha, b.coat_ior);
  const Real lobe_albedo = ggx_albedo(b.grid, o).all();
  lobes.factors = lobe_factors(b, lobe_albedo, o);
  // Rough metal reflects light that arrives along the surface upwards, where more of it leaves the coat.
  const Real up = o.z + (1 - o.z) * mean_alpha(b.alpha);
  const CoatedMetalFactors<Real> leaving = coated_metal_factors(b.coated_metal, up);
  lobes.metal = lobe_albedo * max_component(coated_metal_colour(lobes.factors, leaving, fresnel_of_metal(b, up)));
  const Real sum = lobes.coat + lobes.metal;
  const Real scale = sum > 0 ? 1 / sum : Real(0);
  lobes.coat *= scale, lobes.metal *= scale;
  return lobes;
}

template <class Real>
ALHAZEN_HD BsdfValue<Real> CoatedConductorBsdf<Real>::evaluate(const Vec3<Real>& wo, const Vec3<Real>& wi) const {
  if (!(wo.z * wi.z > 0)) return {};
  const Real side = wo.z < 0 ? Real(-1) : Real(1);
  const Vec3<Real> o = wo * side, i = wi * side;
  const Frame<Real> coat = coat_frame(coat_normal, side);
  const Vec3<Real> coat_o = coat.to_local(o), coat_i = coat.to_local(i);
  const CoatedConductorLobes<Real> lobes = lobes_of(*this, o, coat_o.z);
  const GgxReflection<Real> metal = ggx_reflection(o, i, alpha);
  const CoatedMetalFactors<Real> leaving = coated_metal_factors(coated_metal, i.z);
  BsdfValue<Real> v;
  v.value = coated_metal_colour(lobes.factors, leaving, fresnel_of_metal(*this, metal.cosine)) * metal.value;
  v.pdf = lobes.metal * metal.pdf;
  if (coat_o.z > 0 && coat_i.z > 0) {
    const GgxReflection<Real> ggx = ggx_reflection(coat_o, coat_i, coat_alpha);
    Real cos_t;
    v.value += splat(fresnel_dielectric(ggx.cosine, coat_ior, cos_t) * ggx.value);
    v.pdf += lobes.coat * ggx.pdf;
  }
  return v;
}

template <class Real>
ALHAZEN_HD BsdfSample<Real> CoatedConductorBsdf<Real>::sample(const Vec3<Real>& wo, Real u_lobe,
                                                              const Vec2<Real>& u) const {
  if (wo.z == 0) return {};
  const Real side = wo.z < 0 ? Real(-1) : Real(1);
  const Vec3<Real> o = wo * side;
  const Frame<Real> coat = coat_frame(coat_normal, side);
  const Vec3<Real> coat_o = coat.to_local(o);
  const CoatedConductorLobes<Real> lobes = lobes_of(*this, o, coat_o.z);
  if (u_lobe < lobes.coat)
    return evaluated_sample(*this, wo, coat.to_world(sample_ggx_reflection(coat_o, coat_alpha, u)) * side);
  if (u_lobe < lobes.coat + lobes.metal) return evaluated_sample(*this, wo, sample_ggx_reflection(o, alpha, u) * side);
  return {};
}

}  // namespace ALHAZEN_CORE

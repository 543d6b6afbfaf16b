#pragma once

// pbrt's coated diffuse material: a rough dielectric interface over Lambert's law, without a random walk between the
// two. The interface lets light in and out by tables of albedo, and what the base sends up again is summed to the end
// (docs/formats.md). It is reciprocal, and sends on as much light as arrives where nothing absorbs.

#include "core/materials/closure.h"
#include "core/materials/lobes/albedo_grid.h"
#include "core/materials/lobes/fresnel.h"
#include "core/materials/lobes/microfacet.h"
#include "core/textures/texture_record.h"

namespace ALHAZEN_CORE {

ALHAZEN_HD constexpr MaterialTraits coated_diffuse_traits() { return {}; }

/// What an AlbedoGrid of a coat holds: what its interface reflects, and what it lets through to the base.
struct CoatGrid {
  static constexpr uint32_t interface = 0, transmission = 1;
};

template <class Real>
struct CoatedDiffuseRecord {
  TextureRange reflectance;
  TextureRange roughness_u, roughness_v;  ///< of the interface, scalars; v absent: as u; u absent: smooth
  uint32_t remap_roughness;               ///< 1: alpha = sqrt(roughness)
  uint32_t is_anisotropic;                ///< the alphas may differ
  Real ior;                               ///< of the coat
  Real bounces;                           ///< light meets the base as often as this at most; 0: for ever
  uint32_t interface_albedo;   ///< where in SceneView::albedo_tables the share of light is that the interface reflects
  uint32_t coat_transmission;  ///< the same of what it lets through
  AlbedoGridRecord grid;       ///< CoatGrid, in place of these tables where `is_anisotropic`
};

template <class Real>
struct CoatedDiffuseBsdf {
  Vec2<Real> alpha;
  bool is_anisotropic;
  AlbedoGridPlace<Real> grid;
  const Real* interface_albedo;
  const Real* transmission;
  Real ior;
  Vec3<Real> diffuse;  ///< share of what has entered that leaves the base and the coat again
  Real diffuse_cone;   ///< sine beyond which little light leaves the coat
  Real exit;           ///< 1 / (share of light that leaves from below, times ior^2)

  ALHAZEN_HD BsdfSample<Real> sample(const Vec3<Real>& wo, Real u_lobe, const Vec2<Real>& u) const;
  ALHAZEN_HD ALHAZEN_COLD BsdfValue<Real> evaluate(const Vec3<Real>& wo, const Vec3<Real>& wi) const;
  ALHAZEN_HD Vec3<Real> albedo() const { return min(max(diffuse, Vec3<Real>{}), splat(Real(1))); }
  ALHAZEN_HD constexpr bool is_specular() const { return false; }
};

/// Of light that has come in: the share that a diffuse base sends out again, where the interface sends `back` that
/// share of what meets it from below and lets `escape` out.
template <class Real>
ALHAZEN_HD Real below_coat(Real reflectance, Real back, Real escape, Real bounces) {
  const Real again = reflectance * back;
  // 1 - again, where that is all rounding.
  const Real rest = larger(larger(1 - again, reflectance * escape), Real(1e-30));
  return reflectance * escape * ((bounces > 0 ? 1 - std::pow(again, bounces) : Real(1)) / rest);
}

template <class Real, class Textures>
ALHAZEN_HD ALHAZEN_COLD void make_closure(const CoatedDiffuseRecord<Real>& record, const Textures& textures,
                                          const ClosureView<Real>&, CoatedDiffuseBsdf<Real>& b) {
  b.alpha = textures.layered_alphas(record.roughness_u, record.roughness_v, record.remap_roughness);
  b.is_anisotropic = record.is_anisotropic != 0;
  if (b.is_anisotropic) b.grid = textures.grid(record.grid, b.alpha);
  b.ior = record.ior;
  b.interface_albedo = textures.table(record.interface_albedo);
  b.transmission = textures.table(record.coat_transmission);
  const Real alpha = mean_alpha(b.alpha);
  // With what a rough interface, and the table between its rows, lets out beyond the critical angle.
  b.diffuse_cone = smaller(Real(1), b.ior + 3 * alpha + Real(0.015));
  const Real back = mean_albedo(b.transmission, alpha, CoatColumns::back);
  Real escape = 1 - back;
  if (escape < Real(1e-3)) escape = mean_albedo(b.transmission, alpha, CoatColumns::escape);
  b.exit = mean_albedo(b.transmission, alpha, CoatColumns::scale) / (b.ior * b.ior * larger(escape, Real(1e-30)));
  if (b.is_anisotropic)
    b.exit *= mean_albedo(b.transmission, alpha, CoatColumns::mean) /
              larger(grid_mean(b.grid, CoatGrid::transmission), Real(1e-30));
  const Vec3<Real> reflectance = textures.colour_or(record.reflectance, Real(1));
  b.diffuse = {below_coat(reflectance.x, back, escape, record.bounces),
               below_coat(reflectance.y, back, escape, record.bounces),
               below_coat(reflectance.z, back, escape, record.bounces)};
}

/// Share of light from `w` that the interface reflects.
template <class Real>
ALHAZEN_HD Real interface_albedo(const CoatedDiffuseBsdf<Real>& b, const Vec3<Real>& w) {
  return b.is_anisotropic ? grid_albedo(b.grid, CoatGrid::interface, grid_direction(b.grid, w, b.ior))
                          : lookup_albedo(b.interface_albedo, w.z, b.alpha.x, b.ior);
}

/// Share of light from `w` that gets below the interface.
template <class Real>
ALHAZEN_HD Real coat_transmission(const CoatedDiffuseBsdf<Real>& b, const Vec3<Real>& w) {
  return b.is_anisotropic ? grid_albedo(b.grid, CoatGrid::transmission, grid_direction(b.grid, w, b.ior))
                          : lookup_albedo(b.transmission, w.z, b.alpha.x, b.ior);
}

/// What depends on the outgoing direction alone.
template <class Real>
struct CoatedDiffuseLobes {
  Real specular, diffuse;  ///< probabilities
  Real entering;           ///< share of light that gets to the base
};

template <class Real>
ALHAZEN_HD ALHAZEN_COLD CoatedDiffuseLobes<Real> lobes_of(const CoatedDiffuseBsdf<Real>& b, const Vec3<Real>& o) {
  CoatedDiffuseLobes<Real> lobes;
  lobes.entering = coat_transmission(b, o);
  lobes.specular = interface_albedo(b, o);
  lobes.diffuse = max_component(b.diffuse * lobes.entering);
  const Real sum = lobes.specular + lobes.diffuse;
  const Real scale = sum > 0 ? 1 / sum : Real(0);
  lobes.specular *= scale, lobes.diffuse *= scale;
  return lobes;
}

/// Where light leaves a coat of an index below 1, which refracts it into a cone, most samples of the diffuse lobe go
/// there.
template <class Real>
inline constexpr Real cone_rate = Real(0.9);

template <class Real>
ALHAZEN_HD Vec3<Real> sample_diffuse_lobe(const CoatedDiffuseBsdf<Real>& b, const Vec2<Real>& u) {
  if (b.diffuse_cone >= 1) return sample_cosine_hemisphere(u);
  const bool in_cone = u.x < cone_rate<Real>;
  const Real x = in_cone ? u.x / cone_rate<Real> : (u.x - cone_rate<Real>) / (1 - cone_rate<Real>);
  const Vec2<Real> disk = sample_disk(Vec2<Real>{smaller(x, one_minus_epsilon<Real>), u.y});
  const Real scale = in_cone ? b.diffuse_cone : Real(1);
  const Real dx = disk.x * scale, dy = disk.y * scale;
  return {dx, dy, safe_sqrt(1 - dx * dx - dy * dy)};
}

/// Density of that over the one of cosines.
template <class Real>
ALHAZEN_HD Real diffuse_lobe_density(const CoatedDiffuseBsdf<Real>& b, const Vec3<Real>& i) {
  if (b.diffuse_cone >= 1) return 1;
  const Real cone2 = sqr(b.diffuse_cone), sin2 = i.x * i.x + i.y * i.y;
  return 1 - cone_rate<Real> + (sin2 < cone2 ? cone_rate<Real> / cone2 : Real(0));
}

template <class Real>
ALHAZEN_HD BsdfValue<Real> CoatedDiffuseBsdf<Real>::evaluate(const Vec3<Real>& wo, const Vec3<Real>& wi) const {
  if (!(wo.z * wi.z > 0)) return {};
  const Real side = wo.z < 0 ? Real(-1) : Real(1);
  const Vec3<Real> o = wo * side, i = wi * side;
  const CoatedDiffuseLobes<Real> lobes = lobes_of(*this, o);
  const GgxReflection<Real> ggx = ggx_reflection(o, i, alpha);
  const Real lambert = i.z * inv_pi<Real>;
  Real cos_t;
  BsdfValue<Real> v;
  v.value = splat(fresnel_dielectric(ggx.cosine, ior, cos_t) * ggx.value);
  v.value += diffuse * (lobes.entering * coat_transmission(*this, i) * exit * lambert);
  v.pdf = lobes.specular * ggx.pdf + lobes.diffuse * lambert * diffuse_lobe_density(*this, i);
  return v;
}

template <class Real>
ALHAZEN_HD BsdfSample<Real> CoatedDiffuseBsdf<Real>::sample(const Vec3<Real>& wo, Real u_lobe,
                                                            const Vec2<Real>& u) const {
  if (wo.z == 0) return {};
  const Real side = wo.z < 0 ? Real(-1) : Real(1);
  const Vec3<Real> o = wo * side;
  const CoatedDiffuseLobes<Real> lobes = lobes_of(*this, o);
  if (u_lobe < lobes.specular) return evaluated_sample(*this, wo, sample_ggx_reflection(o, alpha, u) * side);
  if (u_lobe < lobes.specular + lobes.diffuse) return evaluated_sample(*this, wo, sample_diffuse_lobe(*this, u) * side);
  return {};
}

}  // namespace ALHAZEN_CORE

#pragma once

// pbrt's coated diffuse material: a rough dielectric interface over a Lambertian base, without a random walk between
// the two. Albedo tables give the reflectance and transmittance of the interface, and the interreflections below it are
// summed in closed form (docs/formats.md). It is reciprocal; a lossless coat without absorption conserves energy.

#include "core/materials/closure.h"
#include "core/materials/lobes/albedo_grid.h"
#include "core/materials/lobes/fresnel.h"
#include "core/materials/lobes/microfacet.h"
#include "core/textures/texture_record.h"

namespace ALHAZEN_CORE {

ALHAZEN_HD constexpr MaterialTraits coated_diffuse_traits() { return {.is_one_sided = true}; }

/// Quantities in an AlbedoGrid of a coat: the albedo of its interface, and the fraction transmitted to the base.
struct CoatGrid {
  static constexpr uint32_t interface = 0, transmission = 1;
};

template <class Real>
struct CoatedDiffuseRecord {
  TextureRange reflectance;
  TextureRange roughness_u, roughness_v;  ///< scalars, of the interface; v absent: same as u; u absent: smooth
  uint32_t remap_roughness;               ///< 1: alpha = sqrt(roughness)
  uint32_t is_anisotropic;                ///< the alphas may differ
  Real ior;                               ///< of the coat
  Real bounces;                           ///< maximum number of reflections by the base; 0: unlimited
  uint32_t interface_albedo;              ///< offset of the interface's reflectance in SceneView::albedo_tables
  uint32_t coat_transmission;             ///< the same for the coat's transmittance
  AlbedoGridRecord grid;                  ///< CoatGrid, used instead of both tables if `is_anisotropic`
};

template <class Real>
struct CoatedDiffuseBsdf {
  Vec2<Real> alpha;
  bool is_anisotropic;
  AlbedoGridPlace<Real> grid;
  const Real* interface_albedo;
  const Real* transmission;
  Real ior;
  Vec3<Real> diffuse;  ///< fraction of the light reaching the base that leaves the coat again
  Real diffuse_cone;   ///< sine of the angle beyond which little light leaves the coat
  Real exit;           ///< 1 / (fraction of diffuse light from below that leaves * ior^2)

  ALHAZEN_HD BsdfSample<Real> sample(const Vec3<Real>& wo, Real u_lobe, const Vec2<Real>& u) const;
  ALHAZEN_HD ALHAZEN_COLD BsdfValue<Real> evaluate(const Vec3<Real>& wo, const Vec3<Real>& wi) const;
  ALHAZEN_HD Vec3<Real> albedo() const { return min(max(diffuse, Vec3<Real>{}), splat(Real(1))); }
  ALHAZEN_HD constexpr bool is_specular() const { return false; }
};

/// Returns the fraction of the light reaching a diffuse base that leaves the coat again. Of diffuse light from below,
/// the interface reflects the fraction `back` and transmits `escape`. `bounces` > 0 truncates the geometric series.
template <class Real>
ALHAZEN_HD Real below_coat(Real reflectance, Real back, Real escape, Real bounces) {
  const Real again = reflectance * back;
  // 1 - again is never below reflectance * escape, but may cancel to rounding error.
  const Real rest = max(max(1 - again, reflectance * escape), Real(1e-30));
  return reflectance * escape * ((bounces > 0 ? 1 - std::pow(again, bounces) : Real(1)) / rest);
}

template <class Real, TexturesOf<Real> Textures>
ALHAZEN_HD ALHAZEN_COLD void make_closure(const CoatedDiffuseRecord<Real>& record, const Textures& textures,
                                          const ClosureView<Real>&, CoatedDiffuseBsdf<Real>& b) {
  b.alpha = textures.layered_alphas(record.roughness_u, record.roughness_v, record.remap_roughness);
  b.is_anisotropic = record.is_anisotropic != 0;
  if (b.is_anisotropic) b.grid = textures.grid(record.grid, b.alpha);
  b.ior = record.ior;
  b.interface_albedo = textures.table(record.interface_albedo);
  b.transmission = textures.table(record.coat_transmission);
  const Real alpha = mean_alpha(b.alpha);
  // A rough interface, and interpolation between rows of the table, transmit light beyond the critical angle.
  b.diffuse_cone = min(Real(1), b.ior + 3 * alpha + Real(0.015));
  const Real back = mean_albedo(b.transmission, alpha, CoatColumns::back);
  Real escape = 1 - back;
  if (escape < Real(1e-3)) escape = mean_albedo(b.transmission, alpha, CoatColumns::escape);
  b.exit = mean_albedo(b.transmission, alpha, CoatColumns::scale) / (b.ior * b.ior * max(escape, Real(1e-30)));
  if (b.is_anisotropic)
    b.exit *= mean_albedo(b.transmission, alpha, CoatColumns::mean) /
              max(grid_mean(b.grid, CoatGrid::transmission), Real(1e-30));
  const Vec3<Real> reflectance = textures.colour_or(record.reflectance, Real(1));
  b.diffuse = {below_coat(reflectance.x, back, escape, record.bounces),
               below_coat(reflectance.y, back, escape, record.bounces),
               below_coat(reflectance.z, back, escape, record.bounces)};
}

/// Returns the fraction of light from `w` that the interface reflects.
template <class Real>
ALHAZEN_HD Real interface_albedo(const CoatedDiffuseBsdf<Real>& b, const Vec3<Real>& w) {
  return b.is_anisotropic ? grid_albedo(b.grid, CoatGrid::interface, grid_direction(b.grid, w, b.ior))
                          : lookup_albedo(b.interface_albedo, w.z, b.alpha.x, b.ior);
}

/// Returns the fraction of light from `w` that reaches the base.
template <class Real>
ALHAZEN_HD Real coat_transmission(const CoatedDiffuseBsdf<Real>& b, const Vec3<Real>& w) {
  return b.is_anisotropic ? grid_albedo(b.grid, CoatGrid::transmission, grid_direction(b.grid, w, b.ior))
                          : lookup_albedo(b.transmission, w.z, b.alpha.x, b.ior);
}

/// Terms that depend only on the outgoing direction.
template <class Real>
struct CoatedDiffuseLobes {
  Real specular, diffuse;  ///< sampling probabilities
  Real entering;           ///< fraction of light that reaches the base
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

/// Probability of sampling the diffuse lobe within the cone into which a coat with an index below 1 refracts the light
/// that leaves it.
template <class Real>
inline constexpr Real cone_rate = Real(0.9);

template <class Real>
ALHAZEN_HD Vec3<Real> sample_diffuse_lobe(const CoatedDiffuseBsdf<Real>& b, const Vec2<Real>& u) {
  if (b.diffuse_cone >= 1) return sample_cosine_hemisphere(u);
  const bool in_cone = u.x < cone_rate<Real>;
  const Real x = in_cone ? u.x / cone_rate<Real> : (u.x - cone_rate<Real>) / (1 - cone_rate<Real>);
  const Vec2<Real> disk = sample_disk(Vec2<Real>{min(x, one_minus_epsilon<Real>), u.y});
  const Real scale = in_cone ? b.diffuse_cone : Real(1);
  const Real dx = disk.x * scale, dy = disk.y * scale;
  return {dx, dy, safe_sqrt(1 - dx * dx - dy * dy)};
}

/// Returns the density of sample_diffuse_lobe relative to that of cosine-weighted sampling.
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

#pragma once

// The scattering function at a point: a material with its textures evaluated, in the shading frame. One switch each
// for sampling and evaluation. Directions are in world space and point away from the surface.

#include "core/materials/conductor.h"
#include "core/materials/dielectric.h"
#include "core/materials/diffuse.h"
#include "core/math/frame.h"
#include "core/textures/texture.h"

namespace ALHAZEN_CORE {

template <class Real>
struct Bsdf {
  MaterialKind kind;
  Frame<Real> frame;  ///< normal: the shading normal
  Vec3<Real> a;       ///< diffuse: reflectance; conductor: eta
  Vec3<Real> b;       ///< conductor: k
  Real alpha;         ///< conductor, dielectric: roughness of GGX
  Real ior;           ///< dielectric

  ALHAZEN_HD DiffuseBsdf<Real> diffuse() const { return {a}; }
  ALHAZEN_HD ConductorBsdf<Real> conductor() const { return {a, b, alpha}; }
  ALHAZEN_HD DielectricBsdf<Real> dielectric() const { return {ior, alpha}; }

  /// True where a lobe is chosen at random before a direction is.
  ALHAZEN_HD bool has_lobes() const { return kind == MaterialKind::dielectric; }

  /// True where light is only sent in single directions, so that sampling lights is of no use.
  ALHAZEN_HD bool is_specular() const {
    return kind == MaterialKind::conductor
               ? alpha < smooth_alpha<Real>
               : kind == MaterialKind::dielectric && (alpha < smooth_alpha<Real> || ior == 1);
  }
};

template <class Real>
ALHAZEN_HD ALHAZEN_HOT Real evaluate_alpha(const SceneView<Real>& scene, const MaterialRecord<Real>& material,
                                           const TexturePoint<Real>& at) {
  if (material.roughness.count == 0) return 0;
  const Real roughness = clamp(evaluate_texture(scene, material.roughness, at).x, Real(0), Real(1));
  return material.remap_roughness ? std::sqrt(roughness) : roughness;
}

template <class Real>
ALHAZEN_HD ALHAZEN_HOT Bsdf<Real> make_bsdf(const SceneView<Real>& scene, const MaterialRecord<Real>& material,
                                            const TexturePoint<Real>& at, const Vec3<Real>& shading_normal) {
  Bsdf<Real> bsdf{material.kind, frame_about(shading_normal), {}, {}, 0, material.ior};
  switch (material.kind) {
    case MaterialKind::diffuse:
      bsdf.a = max(min(evaluate_texture(scene, material.reflectance, at), splat(Real(1))), Vec3<Real>{});
      break;
    case MaterialKind::conductor:
      bsdf.alpha = evaluate_alpha(scene, material, at);
      if (material.reflectance.count > 0) {
        const Vec3<Real> r = evaluate_texture(scene, material.reflectance, at);
        bsdf.a = splat(Real(1));
        bsdf.b = {absorption_for_reflectance(r.x), absorption_for_reflectance(r.y), absorption_for_reflectance(r.z)};
      } else {
        bsdf.a = evaluate_texture(scene, material.eta, at);
        bsdf.b = evaluate_texture(scene, material.k, at);
      }
      break;
    case MaterialKind::dielectric:
      bsdf.alpha = evaluate_alpha(scene, material, at);
      break;
  }
  return bsdf;
}

/// A direction for light that leaves along `wo`. pdf 0: absorbed.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT BsdfSample<Real> sample_bsdf(const Bsdf<Real>& bsdf, const Vec3<Real>& wo, Real u_lobe,
                                                    const Vec2<Real>& u) {
  const Vec3<Real> local = bsdf.frame.to_local(wo);
  BsdfSample<Real> s;
  switch (bsdf.kind) {
    case MaterialKind::diffuse:
      s = sample_diffuse(bsdf.diffuse(), local, u);
      break;
    case MaterialKind::conductor:
      s = sample_conductor(bsdf.conductor(), local, u);
      break;
    case MaterialKind::dielectric:
      s = sample_dielectric(bsdf.dielectric(), local, u_lobe, u);
      break;
  }
  s.direction = bsdf.frame.to_world(s.direction);
  return s;
}

/// f * |cos| for light from `wi` to `wo`, and the density of `sample_bsdf`. Zero for specular surfaces.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT BsdfValue<Real> evaluate_bsdf(const Bsdf<Real>& bsdf, const Vec3<Real>& wo,
                                                     const Vec3<Real>& wi) {
  const Vec3<Real> o = bsdf.frame.to_local(wo), i = bsdf.frame.to_local(wi);
  switch (bsdf.kind) {
    case MaterialKind::diffuse:
      return evaluate_diffuse(bsdf.diffuse(), o, i);
    case MaterialKind::conductor:
      return evaluate_conductor(bsdf.conductor(), o, i);
    case MaterialKind::dielectric:
      return evaluate_dielectric(bsdf.dielectric(), o, i);
  }
  return {};
}

/// Share of light that the surface sends back at normal incidence, as a guide for denoisers.
template <class Real>
ALHAZEN_HD Vec3<Real> bsdf_albedo(const Bsdf<Real>& bsdf) {
  switch (bsdf.kind) {
    case MaterialKind::diffuse:
      return bsdf.a;
    case MaterialKind::conductor:
      return fresnel_conductor(Real(1), bsdf.a, bsdf.b);
    case MaterialKind::dielectric:
      return splat(Real(1));
  }
  return {};
}

}  // namespace ALHAZEN_CORE

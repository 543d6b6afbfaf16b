#pragma once

// The scattering function at a point: a material with its textures evaluated, in the shading frame. One switch each
// for sampling and evaluation. Directions are in world space and point away from the surface.

#include "core/materials/conductor.h"
#include "core/materials/dielectric.h"
#include "core/materials/diffuse.h"
#include "core/materials/layer_parameters.h"
#include "core/materials/thin_dielectric.h"
#include "core/math/frame.h"
#include "core/textures/texture.h"

namespace ALHAZEN_CORE {

template <class Real>
struct Bsdf {
  MaterialKind kind;
  Frame<Real> frame;  ///< normal: the shading normal
  Vec3<Real> a;       ///< diffuse: reflectance; conductor: eta
  Vec3<Real> b;       ///< conductor: k; diffuse_transmission: transmittance
  Real alpha;         ///< conductor, dielectric: roughness of GGX, of anisotropic ones along the tangent
  Real ior;           ///< dielectrics
  Real alpha_v{};     ///< anisotropic kinds: along the bitangent
  union {
    LayeredBsdf<Real> layered;  ///< of that kind alone; in a union, so that it is not initialised for the others
  };

  ALHAZEN_HD Bsdf() {}
  ALHAZEN_HD Bsdf(MaterialKind kind_, const Frame<Real>& frame_, const Vec3<Real>& a_, const Vec3<Real>& b_,
                  Real alpha_, Real ior_, Real alpha_v_ = 0)
      : kind(kind_), frame(frame_), a(a_), b(b_), alpha(alpha_), ior(ior_), alpha_v(alpha_v_) {}

  ALHAZEN_HD DiffuseBsdf<Real> diffuse() const { return {a}; }
  ALHAZEN_HD ConductorBsdf<Real> conductor() const { return {a, b, alpha}; }
  ALHAZEN_HD DielectricBsdf<Real> dielectric() const { return {ior, alpha}; }
  ALHAZEN_HD ConductorBsdf<Real, Vec2<Real>> anisotropic_conductor() const { return {a, b, {alpha, alpha_v}}; }
  ALHAZEN_HD DielectricBsdf<Real, Vec2<Real>> anisotropic_dielectric() const { return {ior, {alpha, alpha_v}}; }
  ALHAZEN_HD DiffuseTransmissionBsdf<Real> diffuse_transmission() const { return {a, b}; }

  /// True where light is only sent in single directions, so that sampling lights is of no use.
  ALHAZEN_HD bool is_specular() const {
    if (kind == MaterialKind::diffuse) return false;
    return kind == MaterialKind::conductor ? alpha < smooth_alpha<Real>
           : kind == MaterialKind::dielectric || kind == MaterialKind::anisotropic_dielectric
               ? alpha < smooth_alpha<Real> || ior == 1
               : kind == MaterialKind::thin_dielectric;
  }
};

/// Index and absorption of a conductor, or those that give it its colour.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT void set_metal(const SceneView<Real>& scene, const MaterialRecord<Real>& material,
                                      const TexturePoint<Real>& at, Bsdf<Real>& bsdf) {
  if (material.reflectance.count > 0) {
    bsdf.a = splat(Real(1));
    bsdf.b = absorption_for_reflectance(evaluate_texture(scene, material.reflectance, at));
  } else {
    bsdf.a = evaluate_texture(scene, material.eta, at);
    bsdf.b = evaluate_texture(scene, material.k, at);
  }
}

/// Fills the kinds of which there are few.
template <class Real>
ALHAZEN_HD ALHAZEN_COLD void make_rare_bsdf(const SceneView<Real>& scene, const MaterialRecord<Real>& material,
                                            const TexturePoint<Real>& at, Bsdf<Real>& bsdf) {
  const bool remap = material.remap_roughness != 0;
  switch (material.kind) {
    case MaterialKind::anisotropic_conductor:
    case MaterialKind::anisotropic_dielectric:
      bsdf.alpha = larger(alpha_of(scene, material.roughness, remap, at), smooth_alpha<Real>);
      bsdf.alpha_v = larger(alpha_of(scene, material.roughness_v, remap, at), smooth_alpha<Real>);
      if (material.kind == MaterialKind::anisotropic_dielectric) break;
      set_metal(scene, material, at, bsdf);
      break;
    case MaterialKind::diffuse_transmission: {
      bsdf.a = colour_or(scene, material.reflectance, at, Real(0));
      bsdf.b = colour_or(scene, material.transmittance, at, Real(0));
      // No more than all of the light.
      const Vec3<Real> both = max(bsdf.a + bsdf.b, splat(Real(1)));
      bsdf.a = bsdf.a / both;
      bsdf.b = bsdf.b / both;
      break;
    }
    default:
      break;
  }
}

/// Evaluates the textures. The frame is set already; `layered` is left to make_layered.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT void make_bsdf(const SceneView<Real>& scene, const MaterialRecord<Real>& material,
                                      const TexturePoint<Real>& at, Bsdf<Real>& bsdf) {
  bsdf.kind = material.kind;
  bsdf.a = {};
  bsdf.b = {};
  bsdf.alpha = bsdf.alpha_v = 0;
  bsdf.ior = material.ior;
  switch (material.kind) {
    case MaterialKind::diffuse:
      bsdf.a = max(min(evaluate_texture(scene, material.reflectance, at), splat(Real(1))), Vec3<Real>{});
      break;
    case MaterialKind::conductor:
      bsdf.alpha = alpha_of(scene, material.roughness, material.remap_roughness != 0, at);
      set_metal(scene, material, at, bsdf);
      break;
    case MaterialKind::dielectric:
      bsdf.alpha = alpha_of(scene, material.roughness, material.remap_roughness != 0, at);
      break;
    default:
      make_rare_bsdf(scene, material, at, bsdf);
      break;
  }
}

/// The kinds of which there are few; in local coordinates.
template <class Real>
ALHAZEN_HD ALHAZEN_COLD BsdfSample<Real> sample_rare_bsdf(const Bsdf<Real>& bsdf, const Vec3<Real>& wo, Real u_lobe,
                                                          const Vec2<Real>& u) {
  switch (bsdf.kind) {
    case MaterialKind::layered:
      return sample_layered(bsdf.layered, wo, u_lobe, u);
    case MaterialKind::anisotropic_conductor:
      return sample_conductor(bsdf.anisotropic_conductor(), wo, u);
    case MaterialKind::anisotropic_dielectric:
      return sample_dielectric(bsdf.anisotropic_dielectric(), wo, u_lobe, u);
    case MaterialKind::thin_dielectric:
      return sample_thin_dielectric(bsdf.ior, wo, u_lobe);
    case MaterialKind::diffuse_transmission:
      return sample_diffuse_transmission(bsdf.diffuse_transmission(), wo, u_lobe, u);
    default:
      return {};
  }
}

template <class Real>
ALHAZEN_HD ALHAZEN_COLD BsdfValue<Real> evaluate_rare_bsdf(const Bsdf<Real>& bsdf, const Vec3<Real>& wo,
                                                           const Vec3<Real>& wi) {
  switch (bsdf.kind) {
    case MaterialKind::layered:
      return evaluate_layered(bsdf.layered, wo, wi);
    case MaterialKind::anisotropic_conductor:
      return evaluate_conductor(bsdf.anisotropic_conductor(), wo, wi);
    case MaterialKind::anisotropic_dielectric:
      return evaluate_dielectric(bsdf.anisotropic_dielectric(), wo, wi);
    case MaterialKind::diffuse_transmission:
      return evaluate_diffuse_transmission(bsdf.diffuse_transmission(), wo, wi);
    default:
      return {};
  }
}

template <class Real>
ALHAZEN_HD ALHAZEN_HOT BsdfSample<Real> sample_local_bsdf(const Bsdf<Real>& bsdf, const Vec3<Real>& wo, Real u_lobe,
                                                          const Vec2<Real>& u) {
  switch (bsdf.kind) {
    case MaterialKind::diffuse:
      return sample_diffuse(bsdf.diffuse(), wo, u);
    case MaterialKind::conductor:
      return sample_conductor(bsdf.conductor(), wo, u);
    case MaterialKind::dielectric:
      return sample_dielectric(bsdf.dielectric(), wo, u_lobe, u);
    default:
      return sample_rare_bsdf(bsdf, wo, u_lobe, u);
  }
}

/// A direction for light that leaves along `wo`. pdf 0: absorbed.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT BsdfSample<Real> sample_bsdf(const Bsdf<Real>& bsdf, const Vec3<Real>& wo, Real u_lobe,
                                                    const Vec2<Real>& u) {
  BsdfSample<Real> s = sample_local_bsdf(bsdf, bsdf.frame.to_local(wo), u_lobe, u);
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
    default:
      return evaluate_rare_bsdf(bsdf, o, i);
  }
}

/// Share of light that the surface sends back at normal incidence, as a guide for denoisers.
template <class Real>
ALHAZEN_HD Vec3<Real> bsdf_albedo(const Bsdf<Real>& bsdf) {
  switch (bsdf.kind) {
    case MaterialKind::diffuse:
      return bsdf.a;
    case MaterialKind::conductor:
    case MaterialKind::anisotropic_conductor:
      return fresnel_conductor(Real(1), bsdf.a, bsdf.b);
    case MaterialKind::diffuse_transmission:
      return bsdf.a + bsdf.b;
    case MaterialKind::layered:
      return layered_albedo(bsdf.layered);
    default:
      return splat(Real(1));
  }
}

}  // namespace ALHAZEN_CORE

#pragma once

// From the record of a layered material to its scattering function at a point.

#include "core/materials/iridescence.h"
#include "core/materials/layered.h"
#include "core/textures/texture.h"

namespace ALHAZEN_CORE {

template <class Real>
ALHAZEN_HD Real scalar_or(const SceneView<Real>& scene, TextureRange range, const TexturePoint<Real>& at,
                          Real fallback) {
  return range.count == 0 ? fallback : clamp(evaluate_texture(scene, range, at).x, Real(0), Real(1));
}

template <class Real>
ALHAZEN_HD Vec3<Real> colour_or(const SceneView<Real>& scene, TextureRange range, const TexturePoint<Real>& at,
                                Real fallback) {
  return range.count == 0 ? splat(fallback)
                          : max(min(evaluate_texture(scene, range, at), splat(Real(1))), Vec3<Real>{});
}

/// alpha of a roughness as the material's file has it; 0 where there is none.
template <class Real>
ALHAZEN_HD ALHAZEN_HOT Real alpha_of(const SceneView<Real>& scene, TextureRange range, bool remap,
                                     const TexturePoint<Real>& at) {
  if (range.count == 0) return 0;
  const Real roughness = clamp(evaluate_texture(scene, range, at).x, Real(0), Real(1));
  return remap ? std::sqrt(roughness) : roughness;
}

template <class Real>
ALHAZEN_HD Real layered_alpha(Real alpha) {
  return larger(alpha, least_layered_alpha<Real>);
}

/// Of light that has come in: the share that a diffuse base sends out again, where the interface sends `back` that
/// share of what meets it from below.
template <class Real>
ALHAZEN_HD Real below_coat(Real reflectance, Real back, Real bounces) {
  const Real again = reflectance * back;
  const Real sum = (bounces > 0 ? 1 - std::pow(again, bounces) : Real(1)) / larger(Real(1e-6), 1 - again);
  return reflectance * (1 - back) * sum;
}

/// pbrt's coats. The interface lies over Lambert's law, or over metal whose lobe refraction widens.
template <class Real>
ALHAZEN_HD void make_coated(const SceneView<Real>& scene, const MaterialRecord<Real>& material,
                            const LayersRecord<Real>& layers, const TexturePoint<Real>& at, LayeredBsdf<Real>& b) {
  const bool remap = material.remap_roughness != 0;
  const Real u = alpha_of(scene, material.roughness, remap, at);
  const Real v = material.roughness_v.count > 0 ? alpha_of(scene, material.roughness_v, remap, at) : u;
  b.alpha = {layered_alpha(u), layered_alpha(v)};
  const Vec3<Real> reflectance = colour_or(scene, material.reflectance, at, Real(1));
  if (layers.type == LayersType::coated_diffuse) {
    b.dielectric = 1;
    b.ior = material.ior;
    b.interface_albedo = scene.albedo_tables + layers.interface_albedo;
    b.transmission = scene.albedo_tables + layers.coat_transmission;
    const Real back = mean_albedo(b.transmission, std::sqrt(b.alpha.x * b.alpha.y));
    b.exit = 1 / (b.ior * b.ior * larger(Real(1e-3), 1 - back));
    b.diffuse = {below_coat(reflectance.x, back, layers.bounces), below_coat(reflectance.y, back, layers.bounces),
                 below_coat(reflectance.z, back, layers.bounces)};
    return;
  }
  b.coat = 1;
  b.coat_ior = layers.clearcoat_ior;
  b.coat_albedo = scene.albedo_tables + layers.coat_albedo;
  b.coat_alpha = layered_alpha(alpha_of(scene, layers.clearcoat_roughness, remap, at));
  b.metal = 1;
  b.metal_is_exact = true;
  b.coated_metal = coated_metal_place(scene.albedo_tables + layers.coated_metal, layers.coat_varies != 0,
                                      layers.metal_varies != 0, b.coat_alpha, std::sqrt(b.alpha.x * b.alpha.y));
  b.alpha = {coated_metal_alpha(b.coat_alpha, b.alpha.x, b.coat_ior),
             coated_metal_alpha(b.coat_alpha, b.alpha.y, b.coat_ior)};
  if (material.eta.count > 0) {
    b.metal_f0 = evaluate_texture(scene, material.eta, at) / b.coat_ior;
    b.metal_k = evaluate_texture(scene, material.k, at) / b.coat_ior;
  } else {
    b.metal_f0 = splat(1 / b.coat_ior);
    b.metal_k = absorption_for_reflectance(reflectance) / b.coat_ior;
  }
}

/// Dispersion: each ray sees one channel, with the index of that channel (KHR_materials_dispersion).
template <class Real>
ALHAZEN_HD Vec3<Real> disperse(Real dispersion, Real u_channel, Real& ior) {
  const Real spread = (ior - 1) * Real(0.025) * dispersion;
  const int channel = u_channel < Real(1) / 3 ? 0 : u_channel < Real(2) / 3 ? 1 : 2;
  ior = larger(Real(1.0001), ior + spread * static_cast<Real>(channel - 1));
  return {channel == 0 ? Real(3) : Real(0), channel == 1 ? Real(3) : Real(0), channel == 2 ? Real(3) : Real(0)};
}

/// The interface of glass reflects as the film on it does, by the share `film`, and lets in what is left of that. What
/// it reflects without one is known by Fresnel's term where it is smooth and by the tables where it is rough: the one
/// that makes less light counts.
template <class Real>
ALHAZEN_HD void add_film_to_glass(LayeredBsdf<Real>& b, const Vec3<Real>& reflectance, Real film, Real cosine,
                                  Real bare_f0) {
  Real cos_t;
  const Real smooth = fresnel_dielectric(cosine, b.ior, cos_t);
  const Real rough = bare_f0 * lookup_albedo(b.tables + AlbedoTables::base, cosine, b.alpha.y) +
                     b.f90 * lookup_albedo(b.tables + AlbedoTables::edge, cosine, b.alpha.y);
  const Vec3<Real> reflected = lerp(splat(smooth), reflectance, film);
  b.glass_reflection = b.glass_reflection * reflected / clamp(larger(smooth, rough), Real(1e-3), Real(1));
  b.glass_entry = (splat(Real(1)) - reflected) / (1 - clamp(smaller(smooth, rough), Real(0), Real(0.999)));
}

/// Fills `b`. `cosine` is that of the outgoing direction; `u_channel` is a random number for dispersion.
template <class Real>
ALHAZEN_HD ALHAZEN_COLD void make_layered(const SceneView<Real>& scene, const MaterialRecord<Real>& material,
                                          const TexturePoint<Real>& at, Real cosine, Real u_channel,
                                          const Vec3<Real>& coat_normal, LayeredBsdf<Real>& b) {
  const LayersRecord<Real>& layers = scene.layers[material.layers];
  b.tables = scene.albedo_tables;
  b.dielectric = 0, b.interface_albedo = nullptr, b.f0 = {}, b.f90 = 0, b.ior = material.ior;
  b.diffuse = {}, b.diffuse_through = {}, b.transmission = nullptr, b.exit = 1, b.thin = true, b.through = {};
  b.glass = 0, b.glass_reflection = {}, b.glass_entry = {};
  b.metal = 0, b.metal_f0 = {}, b.metal_k = {}, b.metal_is_exact = false, b.coated_metal = {};
  b.coat = 0, b.coat_alpha = least_layered_alpha<Real>, b.coat_ior = layers.clearcoat_ior, b.coat_albedo = nullptr;
  b.coat_normal = coat_normal, b.sheen = {}, b.sheen_roughness = 0;
  if (layers.type != LayersType::principled) return make_coated(scene, material, layers, at, b);

  const Vec3<Real> colour = colour_or(scene, layers.base_colour, at, Real(1));
  const Real roughness = scalar_or(scene, material.roughness, at, Real(1));
  const Real alpha = layered_alpha(roughness * roughness);
  const Real anisotropy = scalar_or(scene, layers.anisotropy, at, Real(0));
  b.alpha = {alpha + (1 - alpha) * anisotropy * anisotropy, alpha};
  b.metal = scalar_or(scene, layers.metallic, at, Real(0));
  const Real rest = 1 - b.metal, transmission = scalar_or(scene, layers.transmission, at, Real(0));
  const Real specular = scalar_or(scene, layers.specular, at, Real(1));
  const Vec3<Real> tint = layers.specular_colour.count == 0
                              ? splat(Real(1))
                              : max(evaluate_texture(scene, layers.specular_colour, at), Vec3<Real>{});
  b.f0 = min(tint * sqr((b.ior - 1) / (b.ior + 1)), splat(Real(1))) * specular;
  b.f90 = specular;
  b.metal_f0 = colour;
  const Vec3<Real> bare_f0 = b.f0;
  Vec3<Real> film_of_dielectric{};
  const Real film = scalar_or(scene, layers.iridescence, at, Real(0));
  if (film > 0) {
    const Real thickness = layers.iridescence_thickness.count == 0
                               ? Real(400)
                               : evaluate_texture(scene, layers.iridescence_thickness, at).x;
    const auto with_film = [&](const Vec3<Real>& f0) {
      const Vec3<Real> reflectance = film_reflectance(cosine, layers.iridescence_ior, larger(thickness, Real(0)), f0);
      return lerp(f0, f0_of_reflectance(reflectance, cosine), film);
    };
    film_of_dielectric = film_reflectance(cosine, layers.iridescence_ior, larger(thickness, Real(0)), b.f0);
    b.f0 = min(with_film(b.f0), splat(larger(b.f90, max_component(b.f0))));
    b.metal_f0 = min(with_film(b.metal_f0), splat(Real(1)));
  }
  b.thin = layers.thin != 0 || std::abs(b.ior - 1) < Real(1e-3);
  b.glass = b.thin ? Real(0) : rest * transmission;
  b.dielectric = rest - b.glass;
  b.diffuse = colour * (rest * (1 - transmission));
  const Real diffuse_transmission = scalar_or(scene, layers.diffuse_transmission, at, Real(0));
  if (diffuse_transmission > 0) {
    b.diffuse *= 1 - diffuse_transmission;
    b.diffuse_through = colour_or(scene, layers.diffuse_transmission_colour, at, Real(1)) *
                        (rest * (1 - transmission) * diffuse_transmission);
  }
  b.through = colour * (rest * transmission);
  b.glass_reflection = min(tint * specular, splat(Real(1)));
  b.glass_entry = splat(Real(1));
  if (film > 0 && b.glass > 0) add_film_to_glass(b, film_of_dielectric, film, cosine, max_component(bare_f0));
  if (b.glass > 0 && layers.dispersion > 0) b.through *= disperse(layers.dispersion, u_channel, b.ior);
  b.coat = scalar_or(scene, layers.clearcoat, at, Real(0));
  const Real coat_roughness = scalar_or(scene, layers.clearcoat_roughness, at, Real(0));
  b.coat_alpha = layered_alpha(coat_roughness * coat_roughness);
  b.coat_albedo = scene.albedo_tables + layers.coat_albedo;
  b.sheen = colour_or(scene, layers.sheen_colour, at, Real(0));
  b.sheen_roughness = larger(scalar_or(scene, layers.sheen_roughness, at, Real(0)), Real(0.07));
}

/// Share of light that comes back at normal incidence, as a guide for denoisers.
template <class Real>
ALHAZEN_HD Vec3<Real> layered_albedo(const LayeredBsdf<Real>& b) {
  const Vec3<Real> base =
      b.f0 * b.dielectric + b.diffuse + b.diffuse_through + b.through + fresnel_of_metal(b, Real(1)) * b.metal;
  return min(max(base, b.sheen), splat(Real(1)));
}

}  // namespace ALHAZEN_CORE

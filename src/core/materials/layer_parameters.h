#pragma once

// From the record of a layered material to its scattering function at a point.

#include "core/materials/layered.h"
#include "core/materials/lobes/thin_film.h"
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

/// Index or absorption of a metal whose square and its square are finite numbers.
template <class Real>
ALHAZEN_HD Vec3<Real> bounded_index(const Vec3<Real>& index) {
  return min(max(index, Vec3<Real>{}), splat(Real(1e8)));
}

/// Of light that has come in: the share that a diffuse base sends out again, where the interface sends `back` that
/// share of what meets it from below and lets `escape` out.
template <class Real>
ALHAZEN_HD Real below_coat(Real reflectance, Real back, Real escape, Real bounces) {
  const Real again = reflectance * back;
  // 1 - again, where that is all rounding.
  const Real rest = larger(larger(1 - again, reflectance * escape), Real(1e-30));
  return reflectance * escape * ((bounces > 0 ? 1 - std::pow(again, bounces) : Real(1)) / rest);
}

/// Lambert's law below an interface.
template <class Real>
ALHAZEN_HD void add_coated_diffuse(const SceneView<Real>& scene, const MaterialRecord<Real>& material,
                                   const LayersRecord<Real>& layers, const Vec3<Real>& reflectance,
                                   LayeredBsdf<Real>& b) {
  b.dielectric = 1;
  b.ior = material.ior;
  b.interface_albedo = scene.albedo_tables + layers.interface_albedo;
  b.transmission = scene.albedo_tables + layers.coat_transmission;
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
  b.diffuse = {below_coat(reflectance.x, back, escape, layers.bounces),
               below_coat(reflectance.y, back, escape, layers.bounces),
               below_coat(reflectance.z, back, escape, layers.bounces)};
}

/// Metal whose lobe refraction widens.
template <class Real>
ALHAZEN_HD void add_coated_metal(const SceneView<Real>& scene, const MaterialRecord<Real>& material,
                                 const LayersRecord<Real>& layers, const TexturePoint<Real>& at,
                                 const Vec3<Real>& reflectance, LayeredBsdf<Real>& b) {
  const Real alpha = mean_alpha(b.alpha);
  b.coat = 1;
  b.coat_ior = layers.clearcoat_ior;
  b.coat_albedo = scene.albedo_tables + layers.coat_albedo;
  b.coat_alpha = layered_alpha(alpha_of(scene, layers.clearcoat_roughness, material.remap_roughness != 0, at));
  b.metal = 1;
  b.metal_is_exact = true;
  b.coated_metal = coated_metal_place(scene.albedo_tables + layers.coated_metal, layers.coat_varies != 0,
                                      layers.metal_varies != 0, b.coat_alpha, alpha, b.coat_ior);
  b.coated_metal_alpha = coated_metal_alpha(b.coat_alpha, alpha, b.coat_ior);
  b.alpha = {coated_metal_alpha(b.coat_alpha, b.alpha.x, b.coat_ior),
             coated_metal_alpha(b.coat_alpha, b.alpha.y, b.coat_ior)};
  if (material.eta.count > 0) {
    b.metal_f0 = evaluate_texture(scene, material.eta, at) / b.coat_ior;
    b.metal_k = evaluate_texture(scene, material.k, at) / b.coat_ior;
  } else {
    b.metal_f0 = splat(1 / b.coat_ior);
    b.metal_k = absorption_for_reflectance(reflectance) / b.coat_ior;
  }
  b.metal_f0 = bounded_index(b.metal_f0), b.metal_k = bounded_index(b.metal_k);
}

/// pbrt's coats.
template <class Real>
ALHAZEN_HD void make_coated(const SceneView<Real>& scene, const MaterialRecord<Real>& material,
                            const LayersRecord<Real>& layers, const TexturePoint<Real>& at, LayeredBsdf<Real>& b) {
  const bool remap = material.remap_roughness != 0;
  const Real u = alpha_of(scene, material.roughness, remap, at);
  const Real v = material.roughness_v.count > 0 ? alpha_of(scene, material.roughness_v, remap, at) : u;
  b.alpha = {layered_alpha(u), layered_alpha(v)};
  const Vec3<Real> reflectance = colour_or(scene, material.reflectance, at, Real(1));
  const bool is_metal = layers.type == LayersType::coated_conductor;
  if (is_metal) add_coated_metal(scene, material, layers, at, reflectance, b);
  if (is_metal || b.is_anisotropic) b.grid = grid_place(scene.albedo_tables, layers.grid, b.alpha);
  if (is_metal && b.is_anisotropic)
    b.through_grid =
        grid_place(scene.albedo_tables, layers.through_grid, Vec2<Real>{b.coated_metal_alpha, b.coated_metal_alpha});
  if (!is_metal) add_coated_diffuse(scene, material, layers, reflectance, b);
}

/// Index of a channel (KHR_materials_dispersion).
template <class Real>
ALHAZEN_HD Real dispersed_ior(Real ior, Real dispersion, int channel) {
  const Real spread = (ior - 1) * Real(0.025) * dispersion;
  return clamp(ior + spread * static_cast<Real>(channel - 1), Real(1.0001), max_layered_ior<Real>);
}

/// Microfacets refract by their slope and the difference of the indices: a sheet of index 1 does not blur. That of
/// glTF's default index, 1.5, blurs as much as it reflects.
template <class Real>
ALHAZEN_HD Real blur_by_ior(Real ior) {
  return smaller(Real(1), std::abs(2 * ior - 2));
}

template <class Real>
ALHAZEN_HD Vec2<Real> thin_alpha(const Vec2<Real>& alpha, Real ior) {
  const Real scale = blur_by_ior(ior);
  return {layered_alpha(alpha.x * scale), layered_alpha(alpha.y * scale)};
}

/// alphas of the principled material's base.
template <class Real>
ALHAZEN_HD Vec2<Real> principled_alpha(Real roughness, Real anisotropy) {
  const Real alpha = layered_alpha(roughness * roughness);
  return {alpha + (1 - alpha) * anisotropy * anisotropy, alpha};
}

/// A film: what it makes of a reflectance at normal incidence, and how much of it there is.
template <class Real>
struct FilmLayer {
  Real amount = 0, ior = 1, thickness = 0;
};

/// Reflectance with the film of an interface that reflects f0 at normal incidence.
template <class Real>
ALHAZEN_HD Vec3<Real> film_reflectance(const FilmLayer<Real>& film, Real cosine, const Vec3<Real>& f0) {
  return film_reflectance(cosine, film.ior, film.thickness, f0);
}

template <class Real>
ALHAZEN_HD FilmLayer<Real> film_of(const SceneView<Real>& scene, const LayersRecord<Real>& layers,
                                   const TexturePoint<Real>& at) {
  FilmLayer<Real> film;
  film.amount = scalar_or(scene, layers.iridescence, at, Real(0));
  if (!(film.amount > 0)) return film;
  film.ior = layers.iridescence_ior;
  film.thickness = larger(
      layers.iridescence_thickness.count == 0 ? Real(400) : evaluate_texture(scene, layers.iridescence_thickness, at).x,
      Real(0));
  return film;
}

/// The film changes what the base reflects, and a dielectric keeps from below it what it reflects in each channel.
template <class Real>
ALHAZEN_HD void add_film(LayeredBsdf<Real>& b, const FilmLayer<Real>& film, Real cosine) {
  const auto with_film = [&](const Vec3<Real>& f0) {
    return lerp(f0, f0_of_reflectance(film_reflectance(film, cosine, f0), cosine), film.amount);
  };
  const Vec3<Real> kept = with_film(b.kept_f0);
  b.f0 = min(with_film(b.f0), splat(larger(b.f90, max_component(b.f0))));
  b.kept_f0 = min(max(b.f0, kept), splat(Real(1)));
  b.metal_f0 = min(with_film(b.metal_f0), splat(Real(1)));
}

/// What microfacets of glass reflect where Fresnel's term of the bare one is `smooth` in this direction and the film
/// has it reflect `wanted`: the one or the other scaled. The tint is part of what the film is over, and so of `wanted`:
/// of what is reflected, that share which is owed to the film is not tinted again.
template <class Real>
ALHAZEN_HD void add_film_to_glass(GlassBsdf<Real>& glass, Real smooth, const Vec3<Real>& wanted, Real amount) {
  for (int c = 0; c < 3; ++c) {
    const Real bare = glass.by_fresnel[c] * smooth, with = bare + (wanted[c] - bare) * amount;
    if (with > 0) glass.tint[c] = 1 - (1 - glass.tint[c]) * smaller(Real(1), bare * (1 - amount) / with);
    if (with >= bare) {
      const Real let_in = (1 - with) / larger(1 - bare, Real(1e-6));
      glass.constant[c] = 1 - let_in;
      glass.by_fresnel[c] *= let_in;
    } else {
      glass.by_fresnel[c] *= with / bare;
    }
  }
}

/// The interface of a body of glass. `cosine` is that of the outgoing direction, negative within.
template <class Real>
ALHAZEN_HD void add_refraction(const SceneView<Real>& scene, const LayersRecord<Real>& layers,
                               const Vec3<Real>& reflection, const Vec3<Real>& f0, const FilmLayer<Real>& film,
                               Real cosine, Real u_channel, LayeredBsdf<Real>& b) {
  GlassBsdf<Real>& glass = b.refraction;
  int channel = 0;
  if (layers.dispersion > 0) {
    // Each ray sees one channel, with the index of that channel.
    channel = u_channel < Real(1) / 3 ? 0 : u_channel < Real(2) / 3 ? 1 : 2;
    b.ior = dispersed_ior(b.ior, layers.dispersion, channel);
    glass.through *= Vec3<Real>{channel == 0 ? Real(3) : Real(0), channel == 1 ? Real(3) : Real(0),
                                channel == 2 ? Real(3) : Real(0)};
  }
  b.body_ior = b.ior;
  glass.interface = {b.ior, b.alpha};
  const Real most = max_component(reflection);
  glass.constant = {}, glass.by_fresnel = splat(most);
  glass.tint = most > 0 ? reflection / most : Vec3<Real>{};
  if (film.amount > 0) {
    const Real outside = cosine < 0 ? safe_sqrt(1 - (1 - cosine * cosine) * sqr(b.ior)) : cosine;
    Real cos_t;
    const Real smooth = fresnel_dielectric(std::abs(cosine), cosine < 0 ? 1 / b.ior : b.ior, cos_t);
    if (smooth < 1) add_film_to_glass(glass, smooth, film_reflectance(film, outside, f0), film.amount);
  }
  glass.albedo = grid_place(scene.albedo_tables, layers.glass[channel], b.alpha);
}

/// Sets what a base of diffuse metal does not need.
template <class Real>
ALHAZEN_HD void clear_layers(const LayersRecord<Real>& layers, Real ior, const Vec3<Real>& coat_normal,
                             LayeredBsdf<Real>& b) {
  b.is_anisotropic = layers.is_anisotropic != 0;
  b.dielectric = 0, b.interface_albedo = nullptr, b.f0 = {}, b.kept_f0 = {}, b.f90 = 0, b.ior = ior;
  b.diffuse = {}, b.diffuse_through = {}, b.body_ior = 1, b.transmission = nullptr;
  b.diffuse_cone = 1, b.exit = 1;
  b.thin = true, b.through_alpha = {}, b.through = {}, b.glass = 0;
  b.metal = 0, b.metal_f0 = {}, b.metal_k = {}, b.metal_is_exact = false, b.coated_metal = {};
  b.coat = 0, b.coat_alpha = least_layered_alpha<Real>, b.coat_ior = layers.clearcoat_ior, b.coat_albedo = nullptr;
  b.coat_normal = coat_normal, b.sheen = {}, b.sheen_roughness = 0;
}

/// Metal and dielectric, and what of the latter goes through.
template <class Real>
ALHAZEN_HD void add_principled_base(const SceneView<Real>& scene, const MaterialRecord<Real>& material,
                                    const LayersRecord<Real>& layers, const TexturePoint<Real>& at, Real cosine,
                                    Real u_channel, LayeredBsdf<Real>& b) {
  const Vec3<Real> colour = colour_or(scene, layers.base_colour, at, Real(1));
  b.alpha = principled_alpha(scalar_or(scene, material.roughness, at, Real(1)),
                             scalar_or(scene, layers.anisotropy, at, Real(0)));
  b.grid = grid_place(scene.albedo_tables, layers.grid, b.alpha);
  b.metal = scalar_or(scene, layers.metallic, at, Real(0));
  const Real rest = 1 - b.metal, transmission = scalar_or(scene, layers.transmission, at, Real(0));
  const Real specular = scalar_or(scene, layers.specular, at, Real(1));
  const Vec3<Real> tint = layers.specular_colour.count == 0
                              ? splat(Real(1))
                              : max(evaluate_texture(scene, layers.specular_colour, at), Vec3<Real>{});
  b.f0 = min(tint * sqr((b.ior - 1) / (b.ior + 1)), splat(Real(1))) * specular;
  b.f90 = specular;
  b.kept_f0 = splat(max_component(b.f0));
  b.metal_f0 = colour;
  const Vec3<Real> bare_f0 = b.f0;
  const FilmLayer<Real> film = film_of(scene, layers, at);
  if (film.amount > 0) add_film(b, film, std::abs(cosine));
  b.thin = layers.thin != 0;
  b.glass = b.thin ? Real(0) : rest * transmission;
  b.dielectric = rest - b.glass;
  b.diffuse = colour * (rest * (1 - transmission));
  const Real diffuse_transmission = scalar_or(scene, layers.diffuse_transmission, at, Real(0));
  if (diffuse_transmission > 0) {
    b.diffuse *= 1 - diffuse_transmission;
    b.diffuse_through = colour_or(scene, layers.diffuse_transmission_colour, at, Real(1)) *
                        (rest * (1 - transmission) * diffuse_transmission);
  }
  if (!b.thin && layers.transmission.count > 0) {
    b.refraction.through = colour;
    add_refraction(scene, layers, min(tint * specular, splat(Real(1))), bare_f0, film, cosine, u_channel, b);
  } else if (transmission > 0) {
    b.through = colour * (rest * transmission);
    b.through_alpha = thin_alpha(b.alpha, b.ior);
    b.through_grid = grid_place(scene.albedo_tables, layers.through_grid, b.through_alpha);
  }
}

/// Fills `b`. `cosine` is that of the outgoing direction to the normal, negative from behind; `u_channel` is a random
/// number for dispersion.
template <class Real>
ALHAZEN_HD ALHAZEN_COLD void make_layered(const SceneView<Real>& scene, const MaterialRecord<Real>& material,
                                          const TexturePoint<Real>& at, Real cosine, Real u_channel,
                                          const Vec3<Real>& coat_normal, LayeredBsdf<Real>& b) {
  const LayersRecord<Real>& layers = scene.layers[material.layers];
  clear_layers(layers, material.ior, coat_normal, b);
  if (layers.type != LayersType::principled) return make_coated(scene, material, layers, at, b);
  add_principled_base(scene, material, layers, at, cosine, u_channel, b);
  b.coat = scalar_or(scene, layers.clearcoat, at, Real(0));
  const Real coat_roughness = scalar_or(scene, layers.clearcoat_roughness, at, Real(0));
  b.coat_alpha = layered_alpha(coat_roughness * coat_roughness);
  b.coat_albedo = scene.albedo_tables + layers.coat_albedo;
  b.sheen = colour_or(scene, layers.sheen_colour, at, Real(0));
  if (is_zero(b.sheen)) return;
  b.sheen_roughness = larger(scalar_or(scene, layers.sheen_roughness, at, Real(0)), Real(0.07));
  const Real sheen_alpha = sqr(b.sheen_roughness);
  b.sheen_grid = grid_place(scene.albedo_tables, layers.sheen_grid, Vec2<Real>{sheen_alpha, sheen_alpha});
}

/// Share of light that comes back at normal incidence, as a guide for denoisers.
template <class Real>
ALHAZEN_HD Vec3<Real> layered_albedo(const LayeredBsdf<Real>& b) {
  Vec3<Real> base =
      b.f0 * b.dielectric + b.diffuse + b.diffuse_through + b.through + fresnel_of_metal(b, Real(1)) * b.metal;
  if (b.glass > 0) base += b.refraction.through * b.glass;
  return min(max(base, b.sheen), splat(Real(1)));
}

}  // namespace ALHAZEN_CORE

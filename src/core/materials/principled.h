#pragma once

// The principled material of glTF 2.0 (appendix B and the KHR_materials extensions): a clearcoat over sheen over a base
// that mixes metal and dielectric, the dielectric over diffuse or transmitted light. What a layer sends back by its
// albedo (core/materials/lobes/albedo_grid.h) is kept from what lies below, so that all layers together send on as much
// light as arrives where none of them absorbs. Light that metal scatters several times is given back by Kulla and
// Conty's lobe, that of glass as core/materials/lobes/rough_glass.h does. Coat and sheen take their light by the
// direction of the camera alone, so these are not reciprocal. There are no single directions: what is smooth has an
// alpha of `least_layered_alpha`.

#include "core/materials/closure.h"
#include "core/materials/lobes/ggx_albedo.h"
#include "core/materials/lobes/microfacet.h"
#include "core/materials/lobes/rough_glass.h"
#include "core/materials/lobes/sheen.h"
#include "core/materials/lobes/thin_film.h"
#include "core/textures/texture_record.h"

namespace ALHAZEN_CORE {

ALHAZEN_HD constexpr MaterialTraits principled_traits() { return {}; }

/// Textures that are absent have the values that Principled of scene/scene.h gives.
template <class Real>
struct PrincipledRecord {
  TextureRange base_colour, metallic, roughness, specular, specular_colour, transmission;
  TextureRange clearcoat, clearcoat_roughness, clearcoat_normal_map;
  TextureRange sheen_colour, sheen_roughness;
  TextureRange iridescence, iridescence_thickness;
  TextureRange anisotropy, anisotropy_direction;
  TextureRange diffuse_transmission, diffuse_transmission_colour;
  Real ior;
  uint32_t thin;                        ///< transmission does not refract: there are no grids of `glass`
  Real rotation_cosine, rotation_sine;  ///< of the anisotropy
  Real iridescence_ior, clearcoat_normal_scale, dispersion;
  uint32_t coat_albedo;           ///< where in SceneView::albedo_tables that of the clearcoat is
  AlbedoGridRecord grid;          ///< GgxGrid of the base
  AlbedoGridRecord through_grid;  ///< thin: GgxGrid of what goes through
  AlbedoGridRecord sheen_grid;
  AlbedoGridRecord glass[3];  ///< not thin: GlassGrid, of each channel where there is dispersion
};

/// Index of the clearcoat.
template <class Real>
inline constexpr Real clearcoat_ior = Real(1.5);

/// What is not used is not initialised.
template <class Real>
struct PrincipledBsdf {
  Vec2<Real> alpha;            ///< of the base
  AlbedoGridPlace<Real> grid;  ///< GgxGrid of the base
  // Dielectric
  Real dielectric;  ///< share of the base that is a dielectric whose back does not refract
  Vec3<Real> f0;
  Vec3<Real> kept_f0;  ///< by which it keeps light from what is below
  Real f90;
  Real ior;
  Vec3<Real> diffuse;          ///< colour below the interface, times the share of the base that has it
  Vec3<Real> diffuse_through;  ///< the same of light that leaves diffusely on the other side
  Real body_ior;               ///< index of what that side is filled with; 1: of a sheet
  // Light that goes through
  Vec3<Real> through;  ///< of a sheet: colour, times the share of the base
  Vec2<Real> through_alpha;
  AlbedoGridPlace<Real> through_grid;  ///< GgxGrid of that
  Real glass;                          ///< share of the base that refracts
  GlassBsdf<Real> refraction;          ///< of that
  // Metal
  Real metal;  ///< share of the base
  Vec3<Real> metal_f0;
  // Layers above
  Real coat, coat_alpha;
  const Real* coat_albedo;
  Vec3<Real> coat_normal;  ///< local
  Vec3<Real> sheen;
  Real sheen_roughness;
  AlbedoGridPlace<Real> sheen_grid;  ///< one quantity

  ALHAZEN_HD BsdfSample<Real> sample(const Vec3<Real>& wo, Real u_lobe, const Vec2<Real>& u) const;
  ALHAZEN_HD ALHAZEN_COLD BsdfValue<Real> evaluate(const Vec3<Real>& wo, const Vec3<Real>& wi) const;
  ALHAZEN_HD Vec3<Real> albedo() const;
  ALHAZEN_HD constexpr bool is_specular() const { return false; }
};

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

template <class Real, class Textures>
ALHAZEN_HD FilmLayer<Real> film_of(const PrincipledRecord<Real>& record, const Textures& textures) {
  FilmLayer<Real> film;
  film.amount = textures.scalar_or(record.iridescence, Real(0));
  if (!(film.amount > 0)) return film;
  film.ior = record.iridescence_ior;
  const bool varies = record.iridescence_thickness.count > 0;
  film.thickness = larger(varies ? textures.value(record.iridescence_thickness).x : Real(400), Real(0));
  return film;
}

/// The film changes what the base reflects, and a dielectric keeps from below it what it reflects in each channel.
template <class Real>
ALHAZEN_HD void add_film(PrincipledBsdf<Real>& b, const FilmLayer<Real>& film, Real cosine) {
  const auto with_film = [&](const Vec3<Real>& f0) {
    return lerp(f0, f0_of_reflectance(film_reflectance(film, cosine, f0), cosine), film.amount);
  };
  const Vec3<Real> kept = with_film(b.kept_f0);
  b.f0 = min(with_film(b.f0), splat(larger(b.f90, max_component(b.f0))));
  b.kept_f0 = min(max(b.f0, kept), splat(Real(1)));
  b.metal_f0 = min(with_film(b.metal_f0), splat(Real(1)));
}

/// Sets the interface of a body of glass and what it reflects, `reflection` times Fresnel's term.
template <class Real, class Textures>
ALHAZEN_HD void add_refraction(const PrincipledRecord<Real>& record, const Textures& textures,
                               const ClosureView<Real>& view, const Vec3<Real>& reflection, const Vec3<Real>& f0,
                               const FilmLayer<Real>& film, PrincipledBsdf<Real>& b) {
  GlassBsdf<Real>& glass = b.refraction;
  int channel = 0;
  if (record.dispersion > 0) {
    // Each ray sees one channel, with the index of that channel.
    channel = view.u_channel < Real(1) / 3 ? 0 : view.u_channel < Real(2) / 3 ? 1 : 2;
    b.ior = dispersed_ior(b.ior, record.dispersion, channel);
    glass.through *= Vec3<Real>{channel == 0 ? Real(3) : Real(0), channel == 1 ? Real(3) : Real(0),
                                channel == 2 ? Real(3) : Real(0)};
  }
  b.body_ior = b.ior;
  glass.interface = {b.ior, b.alpha};
  const Real most = max_component(reflection);
  glass.constant = {}, glass.by_fresnel = splat(most);
  glass.tint = most > 0 ? reflection / most : Vec3<Real>{};
  if (film.amount > 0) {
    const Real cosine = view.cosine;
    const Real outside = cosine < 0 ? safe_sqrt(1 - (1 - cosine * cosine) * sqr(b.ior)) : cosine;
    Real cos_t;
    const Real smooth = fresnel_dielectric(std::abs(cosine), cosine < 0 ? 1 / b.ior : b.ior, cos_t);
    if (smooth < 1) add_film_to_glass(glass, smooth, film_reflectance(film, outside, f0), film.amount);
  }
  glass.albedo = textures.grid(record.glass[channel], b.alpha);
}

/// Sets what goes through the base, which has `colour`: as through a sheet, or into a body.
template <class Real, class Textures>
ALHAZEN_HD void add_light_through(const PrincipledRecord<Real>& record, const Textures& textures,
                                  const ClosureView<Real>& view, const Vec3<Real>& colour, const Vec3<Real>& tint,
                                  const FilmLayer<Real>& film, Real transmission, PrincipledBsdf<Real>& b) {
  const Real rest = 1 - b.metal;
  b.body_ior = 1;
  b.through = {}, b.through_alpha = {};
  b.glass = record.thin != 0 ? Real(0) : rest * transmission;
  if (record.thin == 0 && record.transmission.count > 0) {
    b.refraction.through = colour;
    const Vec3<Real> f0 = min(tint * sqr((b.ior - 1) / (b.ior + 1)), splat(Real(1))) * b.f90;
    add_refraction(record, textures, view, min(tint * b.f90, splat(Real(1))), f0, film, b);
  } else if (transmission > 0) {
    b.through = colour * (rest * transmission);
    b.through_alpha = thin_alpha(b.alpha, b.ior);
    b.through_grid = textures.grid(record.through_grid, b.through_alpha);
  }
}

/// Sets metal and dielectric, and what of the latter goes through.
template <class Real, class Textures>
ALHAZEN_HD void add_base(const PrincipledRecord<Real>& record, const Textures& textures, const ClosureView<Real>& view,
                         PrincipledBsdf<Real>& b) {
  const Vec3<Real> colour = textures.colour_or(record.base_colour, Real(1));
  b.alpha =
      principled_alpha(textures.scalar_or(record.roughness, Real(1)), textures.scalar_or(record.anisotropy, Real(0)));
  b.grid = textures.grid(record.grid, b.alpha);
  b.ior = record.ior;
  b.metal = textures.scalar_or(record.metallic, Real(0));
  b.f90 = textures.scalar_or(record.specular, Real(1));
  const Vec3<Real> tint =
      record.specular_colour.count == 0 ? splat(Real(1)) : max(textures.value(record.specular_colour), Vec3<Real>{});
  b.f0 = min(tint * sqr((b.ior - 1) / (b.ior + 1)), splat(Real(1))) * b.f90;
  b.kept_f0 = splat(max_component(b.f0));
  b.metal_f0 = colour;
  const FilmLayer<Real> film = film_of(record, textures);
  if (film.amount > 0) add_film(b, film, std::abs(view.cosine));
  const Real rest = 1 - b.metal, transmission = textures.scalar_or(record.transmission, Real(0));
  add_light_through(record, textures, view, colour, tint, film, transmission, b);
  b.dielectric = rest - b.glass;
  b.diffuse = colour * (rest * (1 - transmission));
  b.diffuse_through = {};
  const Real diffuse_transmission = textures.scalar_or(record.diffuse_transmission, Real(0));
  if (!(diffuse_transmission > 0)) return;
  b.diffuse *= 1 - diffuse_transmission;
  b.diffuse_through = textures.colour_or(record.diffuse_transmission_colour, Real(1)) *
                      (rest * (1 - transmission) * diffuse_transmission);
}

template <class Real, class Textures>
ALHAZEN_HD void add_sheen(const PrincipledRecord<Real>& record, const Textures& textures, PrincipledBsdf<Real>& b) {
  b.sheen = textures.colour_or(record.sheen_colour, Real(0));
  if (is_zero(b.sheen)) return;
  b.sheen_roughness = larger(textures.scalar_or(record.sheen_roughness, Real(0)), Real(0.07));
  const Real alpha = sqr(b.sheen_roughness);
  b.sheen_grid = textures.grid(record.sheen_grid, Vec2<Real>{alpha, alpha});
}

template <class Real, class Textures>
ALHAZEN_HD ALHAZEN_COLD void make_closure(const PrincipledRecord<Real>& record, const Textures& textures,
                                          const ClosureView<Real>& view, PrincipledBsdf<Real>& b) {
  add_base(record, textures, view, b);
  b.coat = textures.scalar_or(record.clearcoat, Real(0));
  b.coat_alpha = layered_alpha(sqr(textures.scalar_or(record.clearcoat_roughness, Real(0))));
  b.coat_albedo = textures.table(record.coat_albedo);
  b.coat_normal = view.coat_normal;
  add_sheen(record, textures, b);
}

/// By which a dielectric keeps light from what is below, in each channel.
template <class Real>
ALHAZEN_HD Vec3<Real> kept_by_interface(const PrincipledBsdf<Real>& b, const GgxAlbedo<Real>& ggx) {
  const auto channel = [&](Real f0) { return f0 * ggx.base + b.f90 * ggx.edge; };
  return {channel(b.kept_f0.x), channel(b.kept_f0.y), channel(b.kept_f0.z)};
}

template <class Real>
ALHAZEN_HD Vec3<Real> fresnel_of_metal(const PrincipledBsdf<Real>& b, Real cosine) {
  return lerp(b.metal_f0, splat(Real(1)), schlick_weight(cosine));
}

template <class Real>
ALHAZEN_HD Vec3<Real> PrincipledBsdf<Real>::albedo() const {
  Vec3<Real> base = f0 * dielectric + diffuse + diffuse_through + through + fresnel_of_metal(*this, Real(1)) * metal;
  if (glass > 0) base += refraction.through * glass;
  return min(max(base, sheen), splat(Real(1)));
}

/// Colour of light that metal scatters more than once, over that of one that reflects everything.
template <class Real>
ALHAZEN_HD Vec3<Real> metal_multiple(const PrincipledBsdf<Real>& b, Real mean_ggx) {
  const auto channel = [&](Real f0) {
    const Real mean = f0 + (1 - f0) * (Real(1) / 21);
    return mean * mean * mean_ggx / (1 - mean * (1 - mean_ggx));
  };
  return Vec3<Real>{channel(b.metal_f0.x), channel(b.metal_f0.y), channel(b.metal_f0.z)} * b.metal;
}

/// What of the layers depends on the outgoing direction alone: `o.z` > 0.
template <class Real>
struct PrincipledLobes {
  Real coat = 0, specular = 0, diffuse = 0, through = 0;  ///< probabilities
  Real diffuse_through = 0;                               ///< another
  Real below_coat = 1;                                    ///< share that the coat lets through
  Vec3<Real> interface;                                   ///< what the dielectric keeps from below it
  GgxAlbedo<Real> ggx{0, 0};
  Vec3<Real> entering;   ///< share that gets to the diffuse base
  Real metal_scale = 1;  ///< factors on single scattering, mostly 1
  Vec3<Real> interface_scale{1, 1, 1};
  Real sheen = 0;  ///< albedo, of colour 1
  Real below_sheen = 1;
};

/// A body's inside: only its base is hit there, not what lies over it.
template <class Real>
ALHAZEN_HD bool is_within(const PrincipledBsdf<Real>& b, const Vec3<Real>& wo) {
  return wo.z < 0 && b.glass > 0;
}

/// Sets the probabilities of the lobes by how much light each sends on. `coat_albedo` and `sheen`: of the strongest
/// channel.
template <class Real>
ALHAZEN_HD void set_probabilities(const PrincipledBsdf<Real>& b, const Vec3<Real>& o, Real coat_albedo, Real sheen,
                                  PrincipledLobes<Real>& lobes) {
  const Real below = lobes.below_coat, base = below * lobes.below_sheen;
  const Vec3<Real> below_interface = splat(Real(1)) - lobes.interface;
  lobes.coat = coat_albedo;
  lobes.specular =
      base * (b.dielectric * max_component(lobes.interface) +
              (b.metal > 0 ? b.metal * max_component(fresnel_of_metal(b, o.z)) * lobes.ggx.all() : Real(0)));
  lobes.diffuse = below * sheen * lobes.sheen + base * (max_component(b.diffuse * lobes.entering) +
                                                        b.metal * max_component(b.metal_f0) * lobes.ggx.missing());
  lobes.through = base * (b.glass > 0 ? b.glass * larger(max_component(b.refraction.through), Real(0.2))
                                      : max_component(b.through * below_interface));
  lobes.diffuse_through = base * max_component(b.diffuse_through * below_interface);
  const Real sum = lobes.coat + lobes.specular + lobes.diffuse + lobes.diffuse_through + lobes.through;
  const Real scale = sum > 0 ? 1 / sum : Real(0);
  lobes.coat *= scale, lobes.specular *= scale, lobes.diffuse *= scale, lobes.through *= scale;
  lobes.diffuse_through *= scale;
}

template <class Real>
ALHAZEN_HD ALHAZEN_COLD PrincipledLobes<Real> lobes_of(const PrincipledBsdf<Real>& b, const Vec3<Real>& o,
                                                       Real coat_cosine, bool within) {
  PrincipledLobes<Real> lobes;
  Real coat_albedo = 0;
  if (!within && b.coat > 0 && coat_cosine > 0) {
    coat_albedo = b.coat * lookup_albedo(b.coat_albedo, coat_cosine, b.coat_alpha, clearcoat_ior<Real>);
    lobes.below_coat = 1 - coat_albedo;
  }
  lobes.ggx = ggx_albedo(b.grid, o);
  lobes.interface = kept_by_interface(b, lobes.ggx);
  lobes.entering = max(splat(Real(1)) - lobes.interface, Vec3<Real>{});
  const GgxAlbedo<Real> mean = mean_ggx_albedo(b.grid);
  lobes.metal_scale = single_scattering_scale(lobes.ggx.all(), lobes.ggx.missing(), mean.missing());
  const Vec3<Real> kept = kept_by_interface(b, mean);
  if (1 - max_component(kept) < least_mean_missing<Real>)
    for (int c = 0; c < 3; ++c)
      lobes.interface_scale[c] = single_scattering_scale(lobes.interface[c], lobes.entering[c], 1 - kept[c]);
  const Real sheen = within ? Real(0) : max_component(b.sheen);
  if (sheen > 0) {
    lobes.sheen = grid_albedo(b.sheen_grid, 0, grid_direction(b.sheen_grid, o, Real(1)));
    lobes.below_sheen = larger(Real(0), 1 - sheen * lobes.sheen);
  }
  set_probabilities(b, o, coat_albedo, sheen, lobes);
  return lobes;
}

/// Share of light that gets into the diffuse base along that of `lobes` and out of it again along `i`.
template <class Real>
ALHAZEN_HD Vec3<Real> share_of_diffuse_base(const PrincipledBsdf<Real>& b, const PrincipledLobes<Real>& lobes,
                                            const Vec3<Real>& i) {
  const Vec3<Real> leaving = max(splat(Real(1)) - kept_by_interface(b, ggx_albedo(b.grid, i)), Vec3<Real>{});
  const Vec3<Real> mean = splat(Real(1)) - kept_by_interface(b, mean_ggx_albedo(b.grid));
  return lobes.entering * (leaving / max(mean, splat(least_mean_missing<Real>)));
}

/// Sheen and base where both directions are on the same side, what the coat keeps not yet left out.
template <class Real>
ALHAZEN_HD BsdfValue<Real> evaluate_below_coat(const PrincipledBsdf<Real>& b, const PrincipledLobes<Real>& lobes,
                                               const Vec3<Real>& o, const Vec3<Real>& i) {
  BsdfValue<Real> v;
  const GgxReflection<Real> ggx = ggx_reflection(o, i, b.alpha);
  v.value = lerp(b.f0, splat(b.f90), schlick_weight(ggx.cosine)) * (b.dielectric * ggx.value);
  v.value *= lobes.interface_scale;
  v.pdf = lobes.specular * ggx.pdf;
  const Real lambert = i.z * inv_pi<Real>;
  v.pdf += lobes.diffuse * lambert;
  if (max_component(b.diffuse) > 0) v.value += b.diffuse * (share_of_diffuse_base(b, lobes, i) * lambert);
  if (b.metal > 0) {
    const GgxAlbedo<Real> mean = mean_ggx_albedo(b.grid);
    v.value += fresnel_of_metal(b, ggx.cosine) * (b.metal * ggx.value * lobes.metal_scale);
    v.value += metal_multiple(b, mean.all()) * (lambert * lobes.ggx.missing() * ggx_albedo(b.grid, i).missing() /
                                                larger(least_mean_missing<Real>, mean.missing()));
  }
  if (lobes.sheen > 0) {
    v.value *= lobes.below_sheen;
    v.value +=
        b.sheen * (evaluate_sheen(b.sheen_roughness, o, i) / larger(Real(1), max_component(b.sheen) * lobes.sheen));
  }
  return v;
}

/// Light that the base lets through to the other side; `o.z` > 0 > `i.z`.
template <class Real>
ALHAZEN_HD void evaluate_through(const PrincipledBsdf<Real>& b, const PrincipledLobes<Real>& lobes, const Vec3<Real>& o,
                                 const Vec3<Real>& i, bool leaves_body, BsdfValue<Real>& v) {
  const Vec3<Real> mirrored{i.x, i.y, -i.z};
  if (b.glass == 0 && lobes.through > 0) {
    const GgxReflection<Real> ggx = ggx_reflection(o, mirrored, b.through_alpha);
    v.value += b.through * ((splat(Real(1)) - lobes.interface) * ggx.value /
                            larger(ggx_albedo(b.through_grid, o).all(), Real(1e-3)) * lobes.below_sheen);
    v.pdf += lobes.through * ggx.pdf;
  }
  if (lobes.diffuse_through > 0) {
    const Real lambert = mirrored.z * inv_pi<Real>;
    // As radiance does that is refracted.
    const Real crossing = leaves_body ? sqr(b.body_ior) : 1 / sqr(b.body_ior);
    v.value +=
        b.diffuse_through * (lambert * share_of_diffuse_base(b, lobes, mirrored) * (lobes.below_sheen * crossing));
    v.pdf += lobes.diffuse_through * lambert;
  }
}

template <class Real>
ALHAZEN_HD BsdfValue<Real> PrincipledBsdf<Real>::evaluate(const Vec3<Real>& wo, const Vec3<Real>& wi) const {
  if (wo.z == 0 || wi.z == 0) return {};
  const bool within = is_within(*this, wo);
  const Real side = wo.z < 0 ? Real(-1) : Real(1);
  const Vec3<Real> o = wo * side, i = wi * side;
  const Frame<Real> frame = coat_frame(coat_normal, side);
  const Vec3<Real> coat_o = frame.to_local(o);
  const PrincipledLobes<Real> lobes = lobes_of(*this, o, coat_o.z, within);
  BsdfValue<Real> v;
  if (i.z > 0) v = evaluate_below_coat(*this, lobes, o, i);
  if (glass > 0) {
    const BsdfValue<Real> g = evaluate_glass(refraction, wo, wi);
    v.value += g.value * (glass * lobes.below_sheen);
    v.pdf += lobes.through * g.pdf;
  }
  if (i.z < 0) evaluate_through(*this, lobes, o, i, wo.z < 0, v);
  if (coat > 0 && !within) {
    v.value *= lobes.below_coat;
    const Vec3<Real> coat_i = frame.to_local(i);
    if (i.z > 0 && coat_o.z > 0 && coat_i.z > 0) {
      const GgxReflection<Real> ggx = ggx_reflection(coat_o, coat_i, coat_alpha);
      Real cos_t;
      v.value += splat(coat * fresnel_dielectric(ggx.cosine, clearcoat_ior<Real>, cos_t) * ggx.value);
      v.pdf += lobes.coat * ggx.pdf;
    }
  }
  return v;
}

/// A direction of one of the lobes; zero: none.
template <class Real>
ALHAZEN_HD Vec3<Real> sample_lobe(const PrincipledBsdf<Real>& b, const Vec3<Real>& wo, Real u_lobe,
                                  const Vec2<Real>& u) {
  const Real side = wo.z < 0 ? Real(-1) : Real(1);
  const Vec3<Real> o = wo * side;
  const Frame<Real> coat = coat_frame(b.coat_normal, side);
  const Vec3<Real> coat_o = coat.to_local(o);
  const PrincipledLobes<Real> lobes = lobes_of(b, o, coat_o.z, is_within(b, wo));
  Vec3<Real> wi{};
  if (u_lobe < lobes.coat) {
    wi = coat.to_world(sample_ggx_reflection(coat_o, b.coat_alpha, u));
    if (wi.z < 0) return {};
  } else if (u_lobe < lobes.coat + lobes.specular) {
    wi = sample_ggx_reflection(o, b.alpha, u);
    if (wi.z < 0) return {};
  } else if (u_lobe < lobes.coat + lobes.specular + lobes.diffuse) {
    wi = sample_cosine_hemisphere(u);
  } else if (u_lobe < lobes.coat + lobes.specular + lobes.diffuse + lobes.diffuse_through) {
    wi = sample_cosine_hemisphere(u);
    wi.z = -wi.z;
  } else if (b.glass > 0 && lobes.through > 0) {
    const Real rest = (u_lobe - (1 - lobes.through)) / lobes.through;
    return sample_glass(b.refraction, wo, clamp(rest, Real(0), one_minus_epsilon<Real>), u);
  } else {
    wi = sample_ggx_reflection(o, b.through_alpha, u);
    if (wi.z < 0) return {};
    wi.z = -wi.z;
  }
  return wi * side;
}

template <class Real>
ALHAZEN_HD BsdfSample<Real> PrincipledBsdf<Real>::sample(const Vec3<Real>& wo, Real u_lobe, const Vec2<Real>& u) const {
  if (wo.z == 0) return {};
  const Vec3<Real> wi = sample_lobe(*this, wo, u_lobe, u);
  if (is_zero(wi)) return {};
  BsdfSample<Real> s = evaluated_sample(*this, wo, wi);
  if (s.pdf > 0 && wi.z * wo.z < 0) s.eta = wo.z < 0 ? 1 / body_ior : body_ior;
  return s;
}

}  // namespace ALHAZEN_CORE

#pragma once

// The principled material of glTF 2.0 (appendix B and the KHR_materials extensions): a clearcoat over sheen over a base
// that mixes metal and dielectric, where the dielectric interface is over diffuse reflection or transmission. Each
// layer attenuates the layers below by its directional albedo (core/materials/lobes/albedo_grid.h), so that all layers
// together conserve energy if none of them absorbs. Multiple scattering is added by the lobe of Kulla and Conty for
// metal, and as in core/materials/lobes/glass_albedo.h for glass. Clearcoat and sheen attenuate by the outgoing
// direction alone, which is not reciprocal. No lobe is a Dirac delta distribution: smooth layers have the alpha
// `min_layered_alpha`.

#include "core/materials/closure.h"
#include "core/materials/lobes/ggx_albedo.h"
#include "core/materials/lobes/microfacet.h"
#include "core/materials/lobes/rough_glass.h"
#include "core/materials/lobes/sheen.h"
#include "core/materials/lobes/thin_film.h"
#include "core/textures/texture_record.h"

namespace ALHAZEN_CORE {

ALHAZEN_HD constexpr MaterialTraits principled_traits() { return {}; }

/// Absent textures have the default values documented at Principled in scene/scene.h.
template <class Real>
struct PrincipledRecord {
  TextureRange base_colour, metallic, roughness, specular, specular_colour, transmission;
  TextureRange clearcoat, clearcoat_roughness, clearcoat_normal_map;
  TextureRange sheen_colour, sheen_roughness;
  TextureRange iridescence, iridescence_thickness;
  TextureRange anisotropy, anisotropy_direction;
  TextureRange diffuse_transmission, diffuse_transmission_colour;
  Real ior;
  uint32_t thin;                        ///< 1: transmission does not refract, and the grids of `glass` are unused
  Real rotation_cosine, rotation_sine;  ///< of the direction of anisotropy
  Real iridescence_ior, clearcoat_normal_scale, dispersion;
  uint32_t coat_albedo;           ///< offset of the clearcoat's table in SceneView::albedo_tables
  AlbedoGridRecord grid;          ///< GgxGrid of the base
  AlbedoGridRecord through_grid;  ///< if thin: GgxGrid of the transmission lobe
  AlbedoGridRecord sheen_grid;
  AlbedoGridRecord glass[3];  ///< if not thin: GlassGrid of each channel
};

/// Index of refraction of the clearcoat.
template <class Real>
inline constexpr Real clearcoat_ior = Real(1.5);

/// Terms of the layers that depend only on the outgoing direction.
template <class Real>
struct PrincipledLobes {
  bool within;                            ///< the direction is inside a body, where only the base is
  Real coat, specular, diffuse, through;  ///< sampling probabilities
  Real diffuse_through, fuzz;             ///< sampling probabilities; fuzz: of the sheen
  Frame<Real> coat_frame;                 ///< on the side of the direction; set if there is a coat
  Vec3<Real> coat_o;                      ///< the direction in that frame
  Real below_coat;                        ///< fraction transmitted by the coat
  Vec3<Real> interface;                   ///< fraction withheld by the dielectric interface
  GgxAlbedo<Real> ggx, mean_ggx;          ///< for the direction, and the mean over all
  Vec3<Real> entering;                    ///< fraction transmitted to the diffuse base
  Vec3<Real> mean_entering;               ///< its mean over all directions
  Real metal_scale;                       ///< factor on single scattering, usually 1
  Vec3<Real> metal_multiple;              ///< colour of multiple scattering in metal; set if there is metal
  Vec3<Real> interface_scale;             ///< factors on single scattering, usually 1
  Real sheen;                             ///< directional albedo for colour 1
  Real below_sheen;
};

/// Members that are not used are not initialised.
template <class Real>
struct PrincipledBsdf {
  Vec2<Real> alpha;            ///< of the base
  AlbedoGridPlace<Real> grid;  ///< GgxGrid of the base
  // Dielectric
  Real dielectric;  ///< fraction of the base that is dielectric without refraction
  Vec3<Real> f0;
  Vec3<Real> kept_f0;  ///< f0 that determines the attenuation of the layers below
  Real f90;
  Real ior;
  Vec3<Real> diffuse;          ///< diffuse colour below the interface, times its fraction of the base
  Vec3<Real> diffuse_through;  ///< the same for diffuse transmission
  Real body_ior;               ///< index of refraction on the other side; 1: thin sheet
  // Transmission
  Vec3<Real> through;  ///< if thin: colour, times its fraction of the base
  Vec2<Real> through_alpha;
  AlbedoGridPlace<Real> through_grid;  ///< GgxGrid of the transmission lobe
  Real glass;                          ///< fraction of the base that refracts
  GlassBsdf<Real> refraction;          ///< closure of that fraction
  // Metal
  Real metal;  ///< fraction of the base
  Vec3<Real> metal_f0;
  // Layers above
  Real coat, coat_alpha;
  const Real* coat_albedo;
  Vec3<Real> coat_normal;  ///< local
  Vec3<Real> sheen;
  Real sheen_roughness;
  AlbedoGridPlace<Real> sheen_grid;  ///< holds one quantity, the albedo
  // For the direction from which the surface is seen
  Vec3<Real> seen_from;
  PrincipledLobes<Real> lobes;

  ALHAZEN_HD BsdfSample<Real> sample(const Vec3<Real>& wo, Real u_lobe, const Vec2<Real>& u) const;
  ALHAZEN_HD ALHAZEN_COLD BsdfValue<Real> evaluate(const Vec3<Real>& wo, const Vec3<Real>& wi) const;
  ALHAZEN_HD Vec3<Real> albedo() const;
  ALHAZEN_HD constexpr bool is_specular() const { return false; }
  ALHAZEN_HD bool is_one_sided() const { return glass == 0 && is_zero(through) && is_zero(diffuse_through); }
};

/// Returns the index of refraction of a channel (KHR_materials_dispersion).
template <class Real>
ALHAZEN_HD Real dispersed_ior(Real ior, Real dispersion, int channel) {
  const Real spread = (ior - 1) * Real(0.025) * dispersion;
  return clamp(ior + spread * static_cast<Real>(channel - 1), Real(1.0001), max_layered_ior<Real>);
}

/// Returns the factor on alpha for transmission through a thin sheet. Microfacets deflect light in proportion to the
/// difference of the indices: a sheet of index 1 does not blur. At glTF's default index, 1.5, the factor is 1.
template <class Real>
ALHAZEN_HD Real blur_by_ior(Real ior) {
  return min(Real(1), std::abs(2 * ior - 2));
}

template <class Real>
ALHAZEN_HD Vec2<Real> thin_alpha(const Vec2<Real>& alpha, Real ior) {
  const Real scale = blur_by_ior(ior);
  return {layered_alpha(alpha.x * scale), layered_alpha(alpha.y * scale)};
}

/// Returns the alphas of the base.
template <class Real>
ALHAZEN_HD Vec2<Real> principled_alpha(Real roughness, Real anisotropy) {
  const Real alpha = layered_alpha(roughness * roughness);
  return {alpha + (1 - alpha) * anisotropy * anisotropy, alpha};
}

/// A thin film (KHR_materials_iridescence): its weight, index of refraction, and thickness in nanometres.
template <class Real>
struct FilmLayer {
  Real amount = 0, ior = 1, thickness = 0;
};

/// Returns the reflectance, with the film, of an interface whose reflectance at normal incidence is `f0`.
template <class Real>
ALHAZEN_HD Vec3<Real> film_reflectance(const FilmLayer<Real>& film, Real cosine, const Vec3<Real>& f0) {
  return film_reflectance(cosine, film.ior, film.thickness, f0);
}

template <class Real, TexturesOf<Real> Textures>
ALHAZEN_HD FilmLayer<Real> film_of(const PrincipledRecord<Real>& record, const Textures& textures) {
  FilmLayer<Real> film;
  film.amount = textures.scalar_or(record.iridescence, Real(0));
  if (!(film.amount > 0)) return film;
  film.ior = record.iridescence_ior;
  const bool varies = record.iridescence_thickness.count > 0;
  film.thickness = max(varies ? textures.value(record.iridescence_thickness).x : Real(400), Real(0));
  return film;
}

/// Applies the film to the reflectances of the base. The dielectric then attenuates the layers below per channel.
template <class Real>
ALHAZEN_HD void add_film(PrincipledBsdf<Real>& b, const FilmLayer<Real>& film, Real cosine) {
  const auto with_film = [&](const Vec3<Real>& f0) {
    return lerp(f0, f0_of_reflectance(film_reflectance(film, cosine, f0), cosine), film.amount);
  };
  // A film reflects no more than the interface at grazing angles, and the layers below lose no more than that.
  const Vec3<Real> limit = splat(max(b.f90, max_component(b.f0)));
  const Vec3<Real> kept = min(with_film(b.kept_f0), limit);
  b.f0 = min(with_film(b.f0), limit);
  b.kept_f0 = min(max(b.f0, kept), splat(Real(1)));
  b.metal_f0 = min(with_film(b.metal_f0), splat(Real(1)));
}

/// Sets the refracting interface of a body, whose reflectance is `reflection` times the Fresnel reflectance.
template <class Real, TexturesOf<Real> Textures>
ALHAZEN_HD void add_refraction(const PrincipledRecord<Real>& record, const Textures& textures,
                               const ClosureView<Real>& view, const Vec3<Real>& reflection, const Vec3<Real>& f0,
                               const FilmLayer<Real>& film, PrincipledBsdf<Real>& b) {
  GlassBsdf<Real>& glass = b.refraction;
  int channel = 0;
  if (record.dispersion > 0) {
    // One random channel is transmitted, refracted by the index of that channel.
    channel = view.u_channel < Real(1) / 3 ? 0 : view.u_channel < Real(2) / 3 ? 1 : 2;
    b.ior = dispersed_ior(b.ior, record.dispersion, channel);
    glass.through *= Vec3<Real>{channel == 0 ? Real(3) : Real(0), channel == 1 ? Real(3) : Real(0),
                                channel == 2 ? Real(3) : Real(0)};
  }
  b.body_ior = b.ior;
  glass.interface = {b.ior, b.alpha, textures.grid(record.glass[channel], b.alpha)};
  const Real most = max_component(reflection);
  glass.constant = {}, glass.by_fresnel = splat(most);
  glass.tint = most > 0 ? reflection / most : Vec3<Real>{};
  if (film.amount > 0) {
    const Real cosine = view.wo.z;
    const Real outside = cosine < 0 ? safe_sqrt(1 - (1 - cosine * cosine) * sqr(b.ior)) : cosine;
    Real cos_t;
    const Real smooth = fresnel_dielectric(std::abs(cosine), cosine < 0 ? 1 / b.ior : b.ior, cos_t);
    if (smooth < 1) add_film_to_glass(glass, smooth, film_reflectance(film, outside, f0), film.amount);
  }
}

/// Sets the transmission through the base, tinted by `colour`: through a thin sheet, or into a body.
template <class Real, TexturesOf<Real> Textures>
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

/// Sets the metal and the dielectric of the base, with diffuse reflection and transmission.
template <class Real, TexturesOf<Real> Textures>
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
  if (film.amount > 0) add_film(b, film, std::abs(view.wo.z));
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

template <class Real, TexturesOf<Real> Textures>
ALHAZEN_HD void add_sheen(const PrincipledRecord<Real>& record, const Textures& textures, PrincipledBsdf<Real>& b) {
  b.sheen = textures.colour_or(record.sheen_colour, Real(0));
  if (is_zero(b.sheen)) return;
  b.sheen_roughness = max(textures.scalar_or(record.sheen_roughness, Real(0)), Real(0.07));
  const Real alpha = sqr(b.sheen_roughness);
  b.sheen_grid = textures.grid(record.sheen_grid, Vec2<Real>{alpha, alpha});
}

/// Returns the fraction of light that the dielectric interface withholds from the layers below, per channel.
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

/// Returns the albedo of multiple scattering in metal relative to that of a perfect reflector, times `metal`.
template <class Real>
ALHAZEN_HD Vec3<Real> metal_multiple(const PrincipledBsdf<Real>& b, Real mean_ggx) {
  const auto channel = [&](Real f0) {
    const Real mean = f0 + (1 - f0) * (Real(1) / 21);
    return mean * mean * mean_ggx / (1 - mean * (1 - mean_ggx));
  };
  return Vec3<Real>{channel(b.metal_f0.x), channel(b.metal_f0.y), channel(b.metal_f0.z)} * b.metal;
}

/// Returns whether `wo` is inside a body, where light hits only the base and not the layers over it.
template <class Real>
ALHAZEN_HD bool is_within(const PrincipledBsdf<Real>& b, const Vec3<Real>& wo) {
  return wo.z < 0 && b.glass > 0;
}

/// Sets the sampling probabilities of glass. Its own sampling reflects and transmits as if it were clear: as far as it
/// is darker than `clear`, the lobe of GGX reflection is sampled too.
template <class Real>
ALHAZEN_HD void add_glass_probabilities(const PrincipledBsdf<Real>& b, const Vec3<Real>& o, Real base,
                                        PrincipledLobes<Real>& lobes) {
  // Only its own sampling finds multiple scattering, of which there is much within.
  const Real clear = clamp(max_component(b.refraction.through), lobes.within ? Real(0.2) : Real(0.03), Real(1));
  lobes.through = base * b.glass * clear;
  if (clear == 1) return;
  Real cos_t;
  const Real fresnel = fresnel_dielectric(min(o.z, Real(1)), index_beyond(b.body_ior, lobes.within), cos_t);
  const Vec3<Real> reflectance = glass_reflectance(b.refraction, fresnel, !(cos_t > 0));
  const Real reflected = lobes.within ? max_component(reflectance) : max_component(reflectance * b.refraction.tint);
  lobes.specular += base * b.glass * reflected * (1 - clear);
}

/// Sets the sampling probabilities of the lobes in proportion to estimates of their albedos. `sheen` is the largest
/// component of the sheen colour.
template <class Real>
ALHAZEN_HD void set_probabilities(const PrincipledBsdf<Real>& b, const Vec3<Real>& o, Real coat_albedo, Real sheen,
                                  PrincipledLobes<Real>& lobes) {
  const Real below = lobes.below_coat, base = below * lobes.below_sheen;
  const Vec3<Real> below_interface = splat(Real(1)) - lobes.interface;
  const Real metal_f0 = max_component(b.metal_f0);
  lobes.coat = coat_albedo;
  lobes.specular =
      base * (b.dielectric * max_component(lobes.interface) + b.metal * (metal_f0 * lobes.ggx.base + lobes.ggx.edge));
  lobes.diffuse = base * (max_component(b.diffuse * lobes.entering) + b.metal * metal_f0 * lobes.ggx.missing());
  lobes.fuzz = below * min(sheen * lobes.sheen, Real(1));
  if (b.glass > 0)
    add_glass_probabilities(b, o, base, lobes);
  else
    lobes.through = base * max_component(b.through * below_interface);
  lobes.diffuse_through = base * max_component(b.diffuse_through * below_interface);
  const Real sum = lobes.coat + lobes.specular + lobes.diffuse + lobes.fuzz + lobes.diffuse_through + lobes.through;
  const Real scale = sum > 0 ? 1 / sum : Real(0);
  lobes.coat *= scale, lobes.specular *= scale, lobes.diffuse *= scale, lobes.through *= scale;
  lobes.diffuse_through *= scale, lobes.fuzz *= scale;
}

template <class Real>
ALHAZEN_HD ALHAZEN_COLD PrincipledLobes<Real> lobes_of(const PrincipledBsdf<Real>& b, const Vec3<Real>& wo) {
  PrincipledLobes<Real> lobes;
  const Real side = wo.z < 0 ? Real(-1) : Real(1);
  const Vec3<Real> o = wo * side;
  lobes.within = is_within(b, wo);
  lobes.below_coat = 1;
  Real coat_albedo = 0;
  if (b.coat > 0) {
    lobes.coat_frame = coat_frame(b.coat_normal, side);
    lobes.coat_o = lobes.coat_frame.to_local(o);
    if (!lobes.within && lobes.coat_o.z > 0) {
      coat_albedo = b.coat * lookup_albedo(b.coat_albedo, lobes.coat_o.z, b.coat_alpha, clearcoat_ior<Real>);
      lobes.below_coat = 1 - coat_albedo;
    }
  }
  lobes.ggx = ggx_albedo(b.grid, o);
  lobes.mean_ggx = mean_ggx_albedo(b.grid);
  lobes.interface = kept_by_interface(b, lobes.ggx);
  lobes.entering = max(splat(Real(1)) - lobes.interface, Vec3<Real>{});
  lobes.metal_scale = single_scattering_scale(lobes.ggx.all(), lobes.ggx.missing(), lobes.mean_ggx.missing());
  if (b.metal > 0) lobes.metal_multiple = metal_multiple(b, lobes.mean_ggx.all());
  const Vec3<Real> kept = kept_by_interface(b, lobes.mean_ggx);
  lobes.mean_entering = splat(Real(1)) - kept;
  lobes.interface_scale = splat(Real(1));
  if (1 - max_component(kept) < min_mean_missing<Real>)
    for (int c = 0; c < 3; ++c)
      lobes.interface_scale[c] = single_scattering_scale(lobes.interface[c], lobes.entering[c], 1 - kept[c]);
  const Real sheen = lobes.within ? Real(0) : max_component(b.sheen);
  lobes.sheen = 0, lobes.below_sheen = 1;
  if (sheen > 0) {
    lobes.sheen = grid_albedo(b.sheen_grid, 0, grid_direction(b.sheen_grid, o, Real(1)));
    lobes.below_sheen = max(Real(0), 1 - sheen * lobes.sheen);
  }
  set_probabilities(b, o, coat_albedo, sheen, lobes);
  return lobes;
}

template <class Real, TexturesOf<Real> Textures>
ALHAZEN_HD ALHAZEN_COLD void make_closure(const PrincipledRecord<Real>& record, const Textures& textures,
                                          const ClosureView<Real>& view, PrincipledBsdf<Real>& b) {
  add_base(record, textures, view, b);
  b.coat = textures.scalar_or(record.clearcoat, Real(0));
  b.coat_alpha = layered_alpha(sqr(textures.scalar_or(record.clearcoat_roughness, Real(0))));
  b.coat_albedo = textures.table(record.coat_albedo);
  b.coat_normal = view.coat_normal;
  add_sheen(record, textures, b);
  b.seen_from = view.wo;
  b.lobes = lobes_of(b, view.wo);
}

/// Returns the transmittance of the interface into the diffuse base, for the direction of `lobes`, and out of it along
/// a direction with albedo `ggx_i`, normalised by its mean to conserve energy.
template <class Real>
ALHAZEN_HD Vec3<Real> diffuse_base_weight(const PrincipledBsdf<Real>& b, const PrincipledLobes<Real>& lobes,
                                          const GgxAlbedo<Real>& ggx_i) {
  const Vec3<Real> leaving = max(splat(Real(1)) - kept_by_interface(b, ggx_i), Vec3<Real>{});
  return lobes.entering * (leaving / max(lobes.mean_entering, splat(min_mean_missing<Real>)));
}

/// Evaluates sheen and base for two directions on the same side, without attenuation by the coat.
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
  const GgxAlbedo<Real> ggx_i = ggx_albedo(b.grid, i);
  if (max_component(b.diffuse) > 0) v.value += b.diffuse * (diffuse_base_weight(b, lobes, ggx_i) * lambert);
  if (b.metal > 0) {
    v.value += fresnel_of_metal(b, ggx.cosine) * (b.metal * ggx.value * lobes.metal_scale);
    v.value += lobes.metal_multiple * (lambert * lobes.ggx.missing() * ggx_i.missing() /
                                       max(min_mean_missing<Real>, lobes.mean_ggx.missing()));
  }
  if (lobes.sheen > 0) {
    v.value *= lobes.below_sheen;
    v.value += b.sheen * (evaluate_sheen(b.sheen_roughness, o, i) / max(Real(1), max_component(b.sheen) * lobes.sheen));
    v.pdf += lobes.fuzz * pdf_sheen(b.sheen_roughness, i.z);
  }
  return v;
}

/// Adds transmission through the base, other than by glass, to `v`; `o.z` > 0 > `i.z`.
template <class Real>
ALHAZEN_HD void evaluate_through(const PrincipledBsdf<Real>& b, const PrincipledLobes<Real>& lobes, const Vec3<Real>& o,
                                 const Vec3<Real>& i, bool leaves_body, BsdfValue<Real>& v) {
  const Vec3<Real> mirrored{i.x, i.y, -i.z};
  if (b.glass == 0 && lobes.through > 0) {
    const GgxReflection<Real> ggx = ggx_reflection(o, mirrored, b.through_alpha);
    v.value += b.through * ((splat(Real(1)) - lobes.interface) * ggx.value /
                            max(ggx_albedo(b.through_grid, o).all(), Real(1e-3)) * lobes.below_sheen);
    v.pdf += lobes.through * ggx.pdf;
  }
  if (lobes.diffuse_through > 0) {
    const Real lambert = mirrored.z * inv_pi<Real>;
    // Refracted radiance scales with the square of the relative index.
    const Real crossing = leaves_body ? sqr(b.body_ior) : 1 / sqr(b.body_ior);
    v.value += b.diffuse_through *
               (lambert * diffuse_base_weight(b, lobes, ggx_albedo(b.grid, mirrored)) * (lobes.below_sheen * crossing));
    v.pdf += lobes.diffuse_through * lambert;
  }
}

template <class Real>
ALHAZEN_HD BsdfValue<Real> PrincipledBsdf<Real>::evaluate(const Vec3<Real>& wo, const Vec3<Real>& wi) const {
  if (wo.z == 0 || wi.z == 0) return {};
  PrincipledLobes<Real> others;
  const PrincipledLobes<Real>& terms = lobes_for(*this, wo, others);
  const Real side = wo.z < 0 ? Real(-1) : Real(1);
  const Vec3<Real> o = wo * side, i = wi * side;
  BsdfValue<Real> v;
  if (i.z > 0) v = evaluate_below_coat(*this, terms, o, i);
  if (glass > 0) {
    const BsdfValue<Real> g = evaluate_glass(refraction, wo, wi);
    v.value += g.value * (glass * terms.below_sheen);
    v.pdf += terms.through * g.pdf;
  }
  if (i.z < 0) evaluate_through(*this, terms, o, i, wo.z < 0, v);
  if (coat > 0 && !terms.within) {
    v.value *= terms.below_coat;
    const Vec3<Real> coat_o = terms.coat_o, coat_i = terms.coat_frame.to_local(i);
    if (i.z > 0 && coat_o.z > 0 && coat_i.z > 0) {
      const GgxReflection<Real> ggx = ggx_reflection(coat_o, coat_i, coat_alpha);
      Real cos_t;
      v.value += splat(coat * fresnel_dielectric(ggx.cosine, clearcoat_ior<Real>, cos_t) * ggx.value);
      v.pdf += terms.coat * ggx.pdf;
    }
  }
  return v;
}

/// Samples a direction from one of the lobes; returns zero if there is none.
template <class Real>
ALHAZEN_HD Vec3<Real> sample_lobe(const PrincipledBsdf<Real>& b, const Vec3<Real>& wo, Real u_lobe,
                                  const Vec2<Real>& u) {
  const Real side = wo.z < 0 ? Real(-1) : Real(1);
  const Vec3<Real> o = wo * side;
  PrincipledLobes<Real> others;
  const PrincipledLobes<Real>& lobes = lobes_for(b, wo, others);
  Vec3<Real> wi{};
  if (u_lobe < lobes.coat) {
    wi = lobes.coat_frame.to_world(sample_ggx_reflection(lobes.coat_o, b.coat_alpha, u));
    if (wi.z < 0) return {};
  } else if (u_lobe < lobes.coat + lobes.specular) {
    wi = sample_ggx_reflection(o, b.alpha, u);
    if (wi.z < 0) return {};
  } else if (u_lobe < lobes.coat + lobes.specular + lobes.diffuse) {
    wi = sample_cosine_hemisphere(u);
  } else if (u_lobe < lobes.coat + lobes.specular + lobes.diffuse + lobes.fuzz) {
    wi = sample_sheen(b.sheen_roughness, u);
  } else if (u_lobe < lobes.coat + lobes.specular + lobes.diffuse + lobes.fuzz + lobes.diffuse_through) {
    wi = sample_cosine_hemisphere(u);
    wi.z = -wi.z;
  } else if (b.glass > 0 && lobes.through > 0) {
    const Real rest = (u_lobe - (1 - lobes.through)) / lobes.through;
    return sample_glass(b.refraction, wo, clamp(rest, Real(0), one_minus_epsilon<Real>), u);
  } else if (lobes.through > 0) {
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

#pragma once

// The parameters of layers over each other at a point, and the albedos by which a layer leaves light to what is below.

#include "core/materials/coated_metal.h"
#include "core/materials/lobes/albedo_grid.h"
#include "core/materials/lobes/rough_glass.h"
#include "core/math/frame.h"

namespace ALHAZEN_CORE {

/// Beyond these an interface reflects all light but a ten-thousandth, and rounding would have the rest.
template <class Real>
inline constexpr Real min_layered_ior = Real(0.01);
template <class Real>
inline constexpr Real max_layered_ior = Real(1e6);

/// What an AlbedoGrid of GGX holds. Where its Fresnel term is  f0 (1 - s) + f90 s,  s = (1 - cos)^5,  its albedo is
/// f0 * base + f90 * edge.
struct GgxGrid {
  static constexpr uint32_t base = 0, edge = 1;
};
/// And that of a coat over a diffuse base: what its interface reflects, and what it lets through to the base.
struct CoatGrid {
  static constexpr uint32_t interface = 0, transmission = 1;
};

/// The parameters with their textures evaluated. Not initialised where it is not used.
template <class Real>
struct LayeredBsdf {
  Vec2<Real> alpha;            ///< of the base
  bool is_anisotropic;         ///< these may differ
  AlbedoGridPlace<Real> grid;  ///< GgxGrid of the base; CoatGrid of a coat over a diffuse base whose alphas may differ
  // Dielectric
  Real dielectric;               ///< share of the base that is a dielectric whose back does not refract
  const Real* interface_albedo;  ///< exact Fresnel term by `ior`; null: that of f0 and f90
  Vec3<Real> f0;
  Vec3<Real> kept_f0;  ///< by which it keeps light from what is below
  Real f90;
  Real ior;
  Vec3<Real> diffuse;          ///< colour below the interface, times the share of the base that has it
  Vec3<Real> diffuse_through;  ///< the same of light that leaves diffusely on the other side
  Real body_ior;               ///< index of what that side is filled with; 1: of a sheet
  const Real*
      transmission;   ///< what a coat lets through to the diffuse base, and out again; null: what it does not reflect
  Real diffuse_cone;  ///< sine beyond which little light leaves a coat
  Real exit;          ///< of a coat: 1 / (share of light that leaves from below, times ior^2)
  // Light that goes through
  bool thin;
  Vec2<Real> through_alpha;
  AlbedoGridPlace<Real> through_grid;  ///< GgxGrid of that; of coated metal that of coated_metal_alpha
  Vec3<Real> through;                  ///< colour, times the share of the base
  Real glass;                          ///< share of the base that refracts
  GlassBsdf<Real> refraction;          ///< of that
  // Metal
  Real metal;           ///< share of the base
  Vec3<Real> metal_f0;  ///< or, of coated conductors, eta
  Vec3<Real> metal_k;
  bool metal_is_exact;                  ///< by eta and k, relative to the coat above it
  CoatedMetalPlace<Real> coated_metal;  ///< of that
  Real coated_metal_alpha;              ///< that the table is made for, where the alphas differ
  // Layers above
  Real coat, coat_alpha, coat_ior;
  const Real* coat_albedo;
  Vec3<Real> coat_normal;  ///< local
  Vec3<Real> sheen;
  Real sheen_roughness;
  AlbedoGridPlace<Real> sheen_grid;  ///< one quantity

  ALHAZEN_HD LayeredBsdf() {}
};

/// One alpha that stands for both where they differ a little or nothing depends on it much.
template <class Real>
ALHAZEN_HD Real mean_alpha(const Vec2<Real>& alpha) {
  return std::sqrt(alpha.x * alpha.y);
}

/// What GGX reflects from a direction, or from all of them: f0 * base + f90 * edge.
template <class Real>
struct GgxAlbedo {
  Real base, edge;

  ALHAZEN_HD Real all() const { return base + edge; }
  /// Share of light left where both Fresnel terms are 1; 0 or more, whatever rounding does.
  ALHAZEN_HD Real missing() const { return larger(Real(0), 1 - (base + edge)); }
};

template <class Real>
ALHAZEN_HD GgxAlbedo<Real> ggx_albedo(const AlbedoGridPlace<Real>& grid, const Vec3<Real>& w) {
  const GridDirection<Real> d = grid_direction(grid, w, Real(1));
  return {grid_albedo(grid, GgxGrid::base, d), grid_albedo(grid, GgxGrid::edge, d)};
}

template <class Real>
ALHAZEN_HD GgxAlbedo<Real> mean_ggx_albedo(const LayeredBsdf<Real>& b) {
  return {grid_mean(b.grid, GgxGrid::base), grid_mean(b.grid, GgxGrid::edge)};
}

/// Kulla and Conty's lobe has light of all directions leave by what is missing along them, over the mean of that. Near
/// smooth surfaces the mean is next to nothing, and the lobe a spike along the horizon that sampling hardly finds:
/// below this the lobe is weakened, and the rest of the light added to single scattering.
template <class Real>
inline constexpr Real least_mean_missing = Real(1e-3);

/// Factor on single scattering, whose albedo from a direction is `single`, for what the weakened lobe leaves out.
template <class Real>
ALHAZEN_HD Real single_scattering_scale(Real single, Real missing, Real mean_missing) {
  if (mean_missing >= least_mean_missing<Real>) return 1;
  return 1 + missing * (1 - mean_missing / least_mean_missing<Real>) / larger(single, Real(0.1));
}

/// By which a dielectric keeps light from what is below, in each channel.
template <class Real>
ALHAZEN_HD Vec3<Real> kept_by_interface(const LayeredBsdf<Real>& b, const GgxAlbedo<Real>& ggx) {
  const auto channel = [&](Real f0) { return f0 * ggx.base + b.f90 * ggx.edge; };
  return {channel(b.kept_f0.x), channel(b.kept_f0.y), channel(b.kept_f0.z)};
}

/// What the interface keeps from below it, of light from `w`.
template <class Real>
ALHAZEN_HD Vec3<Real> interface_albedo(const LayeredBsdf<Real>& b, const Vec3<Real>& w) {
  if (!b.interface_albedo) return kept_by_interface(b, ggx_albedo(b.grid, w));
  return splat(b.is_anisotropic ? grid_albedo(b.grid, CoatGrid::interface, grid_direction(b.grid, w, b.ior))
                                : lookup_albedo(b.interface_albedo, w.z, b.alpha.x, b.ior));
}

/// Share of light from `w` that gets below the coat.
template <class Real>
ALHAZEN_HD Real coat_transmission(const LayeredBsdf<Real>& b, const Vec3<Real>& w) {
  return b.is_anisotropic ? grid_albedo(b.grid, CoatGrid::transmission, grid_direction(b.grid, w, b.ior))
                          : lookup_albedo(b.transmission, w.z, b.alpha.x, b.ior);
}

/// (1 - cos)^5 of Schlick 1994.
template <class Real>
ALHAZEN_HD Real schlick_share(Real cosine) {
  const Real x = clamp(1 - cosine, Real(0), Real(1));
  return x * x * x * x * x;
}

template <class Real>
ALHAZEN_HD Vec3<Real> fresnel_of_interface(const LayeredBsdf<Real>& b, Real cosine) {
  Real cos_t;
  if (b.interface_albedo) return splat(fresnel_dielectric(cosine, b.ior, cos_t));
  return lerp(b.f0, splat(b.f90), schlick_share(cosine));
}

/// Cosine within the coat of a direction outside.
template <class Real>
ALHAZEN_HD Real cosine_within(Real cosine, Real ior) {
  return safe_sqrt(1 - (1 - cosine * cosine) / (ior * ior));
}

template <class Real>
ALHAZEN_HD Vec3<Real> fresnel_of_metal(const LayeredBsdf<Real>& b, Real cosine) {
  if (b.metal_is_exact) return fresnel_conductor(cosine_within(cosine, b.coat_ior), b.metal_f0, b.metal_k);
  return lerp(b.metal_f0, splat(Real(1)), schlick_share(cosine));
}

/// Colour of light that metal scatters more than once, over that of one that reflects everything.
template <class Real>
ALHAZEN_HD Vec3<Real> metal_multiple(const LayeredBsdf<Real>& b, Real mean_ggx) {
  if (b.metal_is_exact) return {};
  const auto channel = [&](Real f0) {
    const Real mean = f0 + (1 - f0) * (Real(1) / 21);
    return mean * mean * mean_ggx / (1 - mean * (1 - mean_ggx));
  };
  return Vec3<Real>{channel(b.metal_f0.x), channel(b.metal_f0.y), channel(b.metal_f0.z)} * b.metal;
}

template <class Real>
ALHAZEN_HD Frame<Real> coat_frame(const LayeredBsdf<Real>& b, Real side) {
  return frame_about(Vec3<Real>{b.coat_normal.x * side, b.coat_normal.y * side, b.coat_normal.z});
}

}  // namespace ALHAZEN_CORE

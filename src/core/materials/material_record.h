#pragma once

// How materials lie in memory.

#include <cstdint>

#include "core/materials/lobes/albedo_grid.h"
#include "core/textures/texture_record.h"

namespace ALHAZEN_CORE {

/// `layered` and those after it are the rarer ones; GPUs shade them in one queue.
enum class MaterialKind : uint32_t {
  diffuse,
  conductor,
  dielectric,
  layered,                 ///< what its LayersRecord says: principled, coated diffuse, coated conductor
  anisotropic_conductor,   ///< rough, alpha along the tangent differs
  anisotropic_dielectric,  ///< the same
  thin_dielectric,         ///< a pane: both of its sides at once, smooth
  diffuse_transmission,    ///< Lambert on both sides
  mix,                     ///< one of two materials, chosen at each hit
};

/// True where a lobe is chosen at random before a direction is.
ALHAZEN_HD constexpr bool has_lobes(MaterialKind kind) {
  return kind != MaterialKind::diffuse && kind != MaterialKind::conductor;
}

/// What costs something only where it is asked for: bits of MaterialRecord::features.
struct MaterialFeatures {
  static constexpr uint32_t cutout = 1;        ///< may let rays through: by alpha, or as the four last bits say
  static constexpr uint32_t tangents = 2;      ///< normal map, bump, anisotropy: the frame follows dp/du
  static constexpr uint32_t absorbs = 4;       ///< so does what lies behind it, by MaterialRecord::absorption
  static constexpr uint32_t one_sided = 8;     ///< rays of the camera that come from behind go through
  static constexpr uint32_t absent = 16;       ///< lets all rays through: the back of it is what the camera looks at
  static constexpr uint32_t half = 32;         ///< of one side, as is another in its place that looks the other way
  static constexpr uint32_t lit_through = 64;  ///< shadow rays that come from the front go through
};

template <class Real>
struct MaterialRecord {
  MaterialKind kind;
  TextureRange reflectance;  ///< diffuse, diffuse_transmission; conductor without eta and k: colour at normal incidence
  TextureRange eta, k;       ///< conductor, coated conductor
  TextureRange roughness;    ///< scalar; absent: smooth. Of anisotropic kinds that along the tangent
  uint32_t remap_roughness;  ///< 1: alpha = sqrt(roughness)
  Real ior;                  ///< dielectric: inside relative to outside
  uint32_t features;         ///< bits of MaterialFeatures
  TextureRange roughness_v;  ///< anisotropic kinds
  TextureRange transmittance;
  TextureRange opacity;       ///< scalar: share of rays that are stopped; absent: 1
  TextureRange normal_map;    ///< encoded as 0.5 + 0.5 * n
  TextureRange displacement;  ///< scalar, scene units: tilts the normal
  Real normal_scale;
  Vec3<Real> absorption;  ///< per scene unit, behind the surface
  uint32_t layers;        ///< layered: index into SceneView::layers
  uint32_t mixed[2];      ///< mix: indices of materials
  TextureRange amount;    ///< mix: share of the second
};

enum class LayersType : uint32_t { principled, coated_diffuse, coated_conductor };

/// Principled: textures that are absent have the values that Principled of scene/scene.h gives.
template <class Real>
struct LayersRecord {
  LayersType type;
  uint32_t thin;              ///< transmission does not refract: there are no grids of `glass`
  uint32_t interface_albedo;  ///< coats: where in SceneView::albedo_tables that of the interface lies
  uint32_t coat_albedo;       ///< the same of the clearcoat
  TextureRange base_colour, metallic, specular, specular_colour, transmission;
  TextureRange clearcoat, clearcoat_roughness, clearcoat_normal_map;
  TextureRange sheen_colour, sheen_roughness;
  TextureRange iridescence, iridescence_thickness;
  TextureRange anisotropy, anisotropy_direction;
  TextureRange diffuse_transmission, diffuse_transmission_colour;
  Real rotation_cosine, rotation_sine;  ///< of the anisotropy
  Real iridescence_ior, clearcoat_normal_scale, dispersion, clearcoat_ior;
  uint32_t coat_transmission;  ///< coated diffuse: where in SceneView::albedo_tables what the coat lets through lies
  uint32_t coated_metal;       ///< coated conductor: where its table of core/materials/coated_metal.h lies
  uint32_t coat_varies, metal_varies;  ///< and whether that has many roughnesses of the two
  Real bounces;                        ///< coated diffuse: light meets the base as often as this at most; 0: for ever
  uint32_t is_anisotropic;             ///< the alphas of the base may differ
  AlbedoGridRecord grid;               ///< GgxGrid; of a coated diffuse base whose alphas may differ CoatGrid
  AlbedoGridRecord through_grid;       ///< GgxGrid of what goes through a sheet, or of coated metal's mean alpha
  AlbedoGridRecord sheen_grid;
  AlbedoGridRecord glass[3];  ///< principled, not thin: GlassGrid, of each channel where there is dispersion
};

}  // namespace ALHAZEN_CORE

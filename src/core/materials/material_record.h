#pragma once

// The kinds of material, and how they are stored. Each kind has a file of this folder, which holds all that belongs to
// it: the record (textures and numbers), the closure that it becomes at a point (make_closure), how that samples,
// evaluates and what its albedo is, and the traits of the kind. What several kinds are made of is in lobes/.

#include <cstdint>

#include "core/materials/coated_conductor.h"
#include "core/materials/coated_diffuse.h"
#include "core/materials/conductor.h"
#include "core/materials/dielectric.h"
#include "core/materials/diffuse.h"
#include "core/materials/diffuse_transmission.h"
#include "core/materials/mix.h"
#include "core/materials/oren_nayar.h"
#include "core/materials/principled.h"
#include "core/materials/thin_dielectric.h"

namespace ALHAZEN_CORE {

/// Every kind of material, once: KIND(name, Name). Enumeration, storage and every `switch` expand from these lists.
/// The kinds that most surfaces have are shaded inline, on GPUs each in a queue of its own.
#define ALHAZEN_FREQUENT_MATERIALS(KIND) \
  KIND(diffuse, Diffuse)                 \
  KIND(conductor, Conductor)             \
  KIND(dielectric, Dielectric)
/// The others are shaded out of line, on GPUs in one queue. Anisotropic kinds are what conductors and dielectrics are
/// compiled to whose roughness differs by direction; no file describes them.
#define ALHAZEN_RARE_MATERIALS(KIND)                  \
  KIND(principled, Principled)                        \
  KIND(coated_diffuse, CoatedDiffuse)                 \
  KIND(coated_conductor, CoatedConductor)             \
  KIND(anisotropic_conductor, AnisotropicConductor)   \
  KIND(anisotropic_dielectric, AnisotropicDielectric) \
  KIND(thin_dielectric, ThinDielectric)               \
  KIND(diffuse_transmission, DiffuseTransmission)     \
  KIND(oren_nayar, OrenNayar)
/// These have closures; a mix is replaced by one of its materials before.
#define ALHAZEN_SCATTERING_MATERIALS(KIND) ALHAZEN_FREQUENT_MATERIALS(KIND) ALHAZEN_RARE_MATERIALS(KIND)
#define ALHAZEN_MATERIALS(KIND) ALHAZEN_SCATTERING_MATERIALS(KIND) KIND(mix, Mix)

enum class MaterialKind : uint32_t {
#define ALHAZEN_KIND(name, Name) name,
  ALHAZEN_MATERIALS(ALHAZEN_KIND)
#undef ALHAZEN_KIND
};

#define ALHAZEN_KIND(name, Name) +1
inline constexpr uint32_t frequent_material_kinds = 0 ALHAZEN_FREQUENT_MATERIALS(ALHAZEN_KIND);
#undef ALHAZEN_KIND

/// The kinds of which a trait holds, a bit each.
constexpr uint32_t kinds_with(bool MaterialTraits::*trait) {
  uint32_t kinds = 0;
#define ALHAZEN_KIND(name, Name) \
  if (name##_traits().*trait) kinds |= 1u << static_cast<uint32_t>(MaterialKind::name);
  ALHAZEN_MATERIALS(ALHAZEN_KIND)
#undef ALHAZEN_KIND
  return kinds;
}

template <bool MaterialTraits::*trait>
ALHAZEN_HD constexpr bool has_trait(MaterialKind kind) {
  constexpr uint32_t kinds = kinds_with(trait);
  return (kinds >> static_cast<uint32_t>(kind) & 1) != 0;
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

/// A material: what all kinds have, and the record of its own kind.
template <class Real>
struct MaterialRecord {
  MaterialKind kind;
  uint32_t features;          ///< bits of MaterialFeatures
  TextureRange opacity;       ///< scalar: share of rays that are stopped; absent: 1
  TextureRange normal_map;    ///< encoded as 0.5 + 0.5 * n
  TextureRange displacement;  ///< scalar, scene units: tilts the normal
  Real normal_scale;
  Vec3<Real> absorption;  ///< per scene unit, behind the surface
  union {
#define ALHAZEN_KIND(name, Name) Name##Record<Real> name;
    ALHAZEN_MATERIALS(ALHAZEN_KIND)
#undef ALHAZEN_KIND
  };

  /// Sets nothing: the record of one kind alone is in use.
  MaterialRecord() {}
};

}  // namespace ALHAZEN_CORE

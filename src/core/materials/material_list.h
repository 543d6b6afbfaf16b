#pragma once

// The kinds of materials, in descriptions and in compiled scenes. Each kind is defined in a file of this folder: its
// record (textures and numbers), the closure that make_closure creates at a point, with methods to sample and evaluate
// it and to return its albedo, and the traits of the kind. Code shared by several kinds is in lobes/.

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

/// Lists every kind of material once, as KIND(name, Name). The enumeration, the storage and every `switch` expand from
/// these lists. The frequent kinds are shaded inline; on GPUs, each has a queue of its own.
#define ALHAZEN_FREQUENT_MATERIALS(KIND) \
  KIND(diffuse, Diffuse)                 \
  KIND(conductor, Conductor)             \
  KIND(dielectric, Dielectric)
/// The rare kinds are shaded out of line; on GPUs, they share one queue. No scene file names the anisotropic kinds:
/// conductors and dielectrics whose roughness depends on direction are compiled to them.
#define ALHAZEN_RARE_MATERIALS(KIND)                  \
  KIND(principled, Principled)                        \
  KIND(coated_diffuse, CoatedDiffuse)                 \
  KIND(coated_conductor, CoatedConductor)             \
  KIND(anisotropic_conductor, AnisotropicConductor)   \
  KIND(anisotropic_dielectric, AnisotropicDielectric) \
  KIND(thin_dielectric, ThinDielectric)               \
  KIND(diffuse_transmission, DiffuseTransmission)     \
  KIND(oren_nayar, OrenNayar)
/// The kinds that have closures; a mix is replaced by one of its materials first.
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

/// Returns a bit mask of the kinds that have a trait.
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

}  // namespace ALHAZEN_CORE

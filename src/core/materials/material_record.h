#pragma once

// How materials are stored.

#include <cstdint>

#include "core/materials/material_list.h"
#include "core/math/vec.h"
#include "core/textures/texture_record.h"

namespace ALHAZEN_CORE {

/// Bits of MaterialRecord::features, for features that cost time only if a material uses them.
struct MaterialFeatures {
  static constexpr uint32_t cutout = 1;        ///< may be transparent: by opacity, or by one of the last four bits
  static constexpr uint32_t tangents = 2;      ///< normal map, bump map or anisotropy: the frame follows dp/du
  static constexpr uint32_t absorbs = 4;       ///< bounds a medium that absorbs by MaterialRecord::absorption
  static constexpr uint32_t one_sided = 8;     ///< transparent to camera rays from behind
  static constexpr uint32_t absent = 16;       ///< transparent to all rays: the camera sees its back
  static constexpr uint32_t half = 32;         ///< transparent from behind: coincides with an opposite surface
  static constexpr uint32_t lit_through = 64;  ///< transparent to shadow rays from the front
};

/// A material: members common to all kinds, and the record of its kind.
template <class Real>
struct MaterialRecord {
  MaterialKind kind;
  uint32_t features;          ///< bits of MaterialFeatures
  TextureRange opacity;       ///< scalar: fraction of rays that are stopped; absent: 1
  TextureRange normal_map;    ///< encoded as 0.5 + 0.5 * n
  TextureRange displacement;  ///< scalar, scene units: perturbs the normal
  Real normal_scale;
  Vec3<Real> absorption;  ///< per scene unit, behind the surface
  union {
#define ALHAZEN_KIND(name, Name) Name##Record<Real> name;
    ALHAZEN_MATERIALS(ALHAZEN_KIND)
#undef ALHAZEN_KIND
  };

  /// Initialises nothing: only the record of one kind is used.
  MaterialRecord() {}
};

}  // namespace ALHAZEN_CORE

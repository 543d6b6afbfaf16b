#pragma once

// How materials lie in memory.

#include <cstdint>

#include "core/textures/record.h"

namespace ALHAZEN_CORE {

enum class MaterialKind : uint32_t { diffuse, conductor, dielectric };

template <class Real>
struct MaterialRecord {
  MaterialKind kind;
  TextureRange reflectance;  ///< diffuse; conductor without eta and k: colour at normal incidence
  TextureRange eta, k;       ///< conductor
  TextureRange roughness;    ///< scalar; absent: smooth
  uint32_t remap_roughness;  ///< 1: alpha = sqrt(roughness)
  Real ior;                  ///< dielectric: inside relative to outside
};

}  // namespace ALHAZEN_CORE

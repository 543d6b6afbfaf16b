#pragma once

// A mix selects one of two materials at random at each hit. It has no closure of its own: that of the selected material
// is made.

#include "core/materials/closure.h"
#include "core/textures/texture_record.h"

namespace ALHAZEN_CORE {

ALHAZEN_HD constexpr MaterialTraits mix_traits() { return {}; }

template <class Real>
struct MixRecord {
  uint32_t materials[2];  ///< indices into SceneView::materials, which may be mixes in turn
  TextureRange amount;    ///< scalar: probability of the second material

  /// Returns the index of the material that the random number `u` selects.
  template <TexturesOf<Real> Textures>
  ALHAZEN_HD uint32_t select(const Textures& textures, Real u) const {
    return materials[u < textures.value(amount).x ? 1 : 0];
  }
};

}  // namespace ALHAZEN_CORE

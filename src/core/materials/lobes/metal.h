#pragma once

// Parameters of metals: index of refraction and absorption coefficient, or a colour.

#include "core/materials/lobes/fresnel.h"
#include "core/textures/texture_record.h"

namespace ALHAZEN_CORE {

struct MetalRecord {
  TextureRange reflectance;  ///< colour at normal incidence; absent if eta and k are given
  TextureRange eta, k;
};

/// Sets the index and absorption coefficient relative to the outside; those that reproduce the colour if it is given.
template <class Real, TexturesOf<Real> Textures>
ALHAZEN_HD ALHAZEN_HOT void set_metal(const MetalRecord& metal, const Textures& textures, Vec3<Real>& eta,
                                      Vec3<Real>& k) {
  if (metal.reflectance.count > 0) {
    eta = splat(Real(1));
    k = absorption_for_reflectance(textures.value(metal.reflectance));
  } else {
    eta = textures.value(metal.eta);
    k = textures.value(metal.k);
  }
}

}  // namespace ALHAZEN_CORE

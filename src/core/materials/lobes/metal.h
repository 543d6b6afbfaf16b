#pragma once

// How metals are described: by index and absorption, or by a colour.

#include "core/materials/lobes/fresnel.h"
#include "core/textures/texture_record.h"

namespace ALHAZEN_CORE {

struct MetalRecord {
  TextureRange reflectance;  ///< colour at normal incidence; absent where eta and k are given
  TextureRange eta, k;
};

/// Sets index and absorption relative to the outside, or those that give the metal its colour.
template <class Real, class Textures>
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

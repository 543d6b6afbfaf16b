#pragma once

// What every material returns when a direction is sampled. Local coordinates: z along the shading normal, both
// directions pointing away from the surface.

#include <cstdint>

#include "core/math/scalar.h"
#include "core/math/vec.h"

namespace ALHAZEN_CORE {

template <class Real>
struct BsdfSample {
  Vec3<Real> direction{};
  Vec3<Real> weight{};    ///< f * |cos| / pdf; for a specular direction the limit of that
  Real pdf = 0;           ///< over solid angle; of no meaning where specular; 0: nothing was sampled
  Real eta = 1;           ///< index beyond the surface relative to this side if transmitted, else 1
  uint32_t specular = 0;  ///< 1: light is sent in single directions alone
};

/// f * |cos| and the density with which `sample` would have returned the direction.
template <class Real>
struct BsdfValue {
  Vec3<Real> value{};
  Real pdf = 0;
};

}  // namespace ALHAZEN_CORE

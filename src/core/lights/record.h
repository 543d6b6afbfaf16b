#pragma once

// How lights lie in memory.

#include <cstdint>

#include "core/math/vec.h"
#include "core/shapes/records.h"

namespace ALHAZEN_CORE {

enum class LightKind : uint32_t { triangle, sphere, moving_sphere, point, spot, distant, constant_infinite };

template <class Real>
struct LightRecord {
  LightKind kind;
  uint32_t primitive;   ///< triangle, sphere, moving_sphere: index into the array of that kind
  Vec3<Real> radiance;  ///< radiance; point and spot: intensity; distant: irradiance at normal incidence
  uint32_t two_sided;   ///< shapes: emits on both sides
  Real pmf;             ///< probability that this light is chosen
  Vec3<Real> position;
  Vec3<Real> direction;       ///< the way the light travels, unit length
  Real cos_outer, cos_inner;  ///< spot: cosines where the light ends and where the falloff begins
};

}  // namespace ALHAZEN_CORE

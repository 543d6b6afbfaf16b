#pragma once

// The kinds of lights, described and compiled. Those with an area come from shapes that emit.

#include <cstdint>

#include "core/math/platform.h"

namespace ALHAZEN_CORE {

enum class LightKind : uint32_t {
  triangle,
  sphere,
  moving_sphere,
  point,
  spot,               ///< a point light about a direction, with a falloff
  distant,            ///< of one direction
  constant_infinite,  ///< the same radiance from every direction
  environment,        ///< radiance from every direction by a map
  goniometric,        ///< a point light times an image of all directions, square and equal-area octahedral
  projection          ///< a point light that projects an image along z of its axes; x is to the right of it, y up
};

}  // namespace ALHAZEN_CORE

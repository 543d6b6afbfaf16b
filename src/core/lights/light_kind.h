#pragma once

// The kinds of lights, in descriptions and in compiled scenes. Area lights are emissive shapes.

#include <cstdint>

#include "core/math/platform.h"

namespace ALHAZEN_CORE {

enum class LightKind : uint32_t {
  triangle,
  sphere,
  moving_sphere,
  point,
  spot,               ///< a point light with a falloff about a direction
  distant,            ///< light from a single direction
  constant_infinite,  ///< the same radiance from every direction
  environment,        ///< radiance from every direction, given by a map
  goniometric,        ///< a point light scaled by an equal-area octahedral image of all directions
  projection          ///< a point light that projects an image along its z axis; x points right in the image, y up
};

}  // namespace ALHAZEN_CORE

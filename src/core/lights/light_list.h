#pragma once

// The kinds of lights, in descriptions and in compiled scenes. Emissive shapes are in light.h; each other kind is
// defined in a file of kinds/: its traits, the numbers that its record holds, its power, how it is sampled, and what
// rays that escape find of it.

#include <cstdint>

#include "core/lights/kinds/constant_infinite.h"
#include "core/lights/kinds/distant.h"
#include "core/lights/kinds/environment.h"
#include "core/lights/kinds/goniometric.h"
#include "core/lights/kinds/point.h"
#include "core/lights/kinds/projection.h"
#include "core/lights/kinds/spot.h"
#include "core/lights/kinds/sun.h"

namespace ALHAZEN_CORE {

/// Lists every kind of light that is not a shape once, as KIND(name, Name). The enumeration, sampling, compilation, the
/// light tree's bounds and the search for missed caustics expand from it.
#define ALHAZEN_LIGHTS(KIND)                \
  KIND(point, Point)                        \
  KIND(spot, Spot)                          \
  KIND(distant, Distant)                    \
  KIND(constant_infinite, ConstantInfinite) \
  KIND(environment, Environment)            \
  KIND(goniometric, Goniometric)            \
  KIND(projection, Projection)              \
  KIND(sun, Sun)

enum class LightKind : uint32_t {
  triangle,
  sphere,
  moving_sphere,
#define ALHAZEN_KIND(name, Name) name,
  ALHAZEN_LIGHTS(ALHAZEN_KIND)
#undef ALHAZEN_KIND
};

constexpr LightTraits light_traits(LightKind kind) {
  switch (kind) {
#define ALHAZEN_CASE(name, Name) \
  case LightKind::name:          \
    return Name##Light::traits;
    ALHAZEN_LIGHTS(ALHAZEN_CASE)
#undef ALHAZEN_CASE
    case LightKind::triangle:
    case LightKind::sphere:
    case LightKind::moving_sphere:
      break;
  }
  return {.name = "emissive shape", .has_size = true};
}

}  // namespace ALHAZEN_CORE

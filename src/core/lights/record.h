#pragma once

// How lights lie in memory.

#include <cstdint>

#include "core/lights/sphere_mapping.h"
#include "core/math/frame.h"
#include "core/math/vec.h"
#include "core/shapes/records.h"

namespace ALHAZEN_CORE {

enum class LightKind : uint32_t {
  triangle,
  sphere,
  moving_sphere,
  point,
  spot,
  distant,
  constant_infinite,
  environment
};

template <class Real>
struct LightRecord {
  LightKind kind;
  uint32_t primitive;   ///< shapes and environment: index into the array of that kind
  Vec3<Real> radiance;  ///< radiance; point and spot: intensity; distant: irradiance at normal incidence;
                        ///< environment: mean over all directions
  uint32_t two_sided;   ///< shapes: emits on both sides
  Real pmf;             ///< probability that this light is chosen
  Vec3<Real> position;
  Vec3<Real> direction;       ///< the way the light travels, unit length
  Real cos_outer, cos_inner;  ///< spot: cosines where the light ends and where the falloff begins
};

/// A map's texels lie as an image's in texel_floats, linear. Its distribution lies in environment_cdf: height + 1
/// values over the rows, then width + 1 for each row.
template <class Real>
struct EnvironmentRecord {
  uint64_t first_texel, first_cdf;
  uint32_t width, height;
  SphereMapping mapping;
  uint32_t light;    ///< its index in `lights`
  Frame<Real> axes;  ///< x, y and z of the map in the world: orthonormal, of either handedness
  Vec3<Real> scale;  ///< factor on the texels
};

}  // namespace ALHAZEN_CORE

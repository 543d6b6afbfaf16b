#pragma once

// The kinds of texture nodes and how images continue past their edges.

#include <cstdint>

#include "core/math/platform.h"

namespace ALHAZEN_CORE {

enum class TextureKind : uint32_t {
  constant,
  checkerboard,  ///< one of two textures, over uv or in 3D
  image,
  fbm,            ///< Perlin noise summed over octaves
  wrinkled,       ///< the same with absolute values (turbulence)
  marble,         ///< a fixed spline of colours over displaced veins
  scale,          ///< product of two textures
  mix,            ///< two textures blended by a third
  channel,        ///< one channel of a texture, replicated to all three
  vertex_colour,  ///< interpolated over the mesh; white if it has none
  vertex_alpha,   ///< the same for the fourth channel
  coordinates,    ///< (s, t, 0) of the mapping
  dots,           ///< one of two textures: inside or outside discs that noise scatters over (s, t)
  windy,          ///< waves on water under wind: a product of two noises
  direction_mix,  ///< two textures blended by the cosine of the normal and a direction
  threshold,      ///< 1 where a texture is at least the value, else 0
};

/// The source of a texture's (s, t): a uv set of the surface, or the point in texture space.
enum class TextureMappingKind : uint32_t { uv, spherical, cylindrical, planar };

enum class WrapMode : uint32_t { repeat, black, clamp, mirror };

}  // namespace ALHAZEN_CORE

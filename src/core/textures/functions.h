#pragma once

// The kinds of texture nodes and how images continue past their edges.

#include <cstdint>

#include "core/math/platform.h"

namespace ALHAZEN_CORE {

enum class TextureKind : uint32_t {
  constant,
  checkerboard,  ///< one of two textures, over uv or in space
  image,
  fbm,            ///< Perlin noise summed over octaves
  wrinkled,       ///< the same of its absolute value (turbulence)
  marble,         ///< a fixed spline of colours over displaced veins
  scale,          ///< product of two textures
  mix,            ///< two textures blended by a third
  channel,        ///< one channel of a texture, in all three
  vertex_colour,  ///< interpolated over the mesh; white where it has none
  vertex_alpha,   ///< the same of its fourth channel
  coordinates,    ///< (s, t, 0) of the mapping
  dots,           ///< one of two textures: within discs that noise scatters over (s, t), or outside
  windy,          ///< waves on water under wind: a product of two noises
  direction_mix,  ///< two textures blended by the cosine of the normal and a direction
  threshold,      ///< 1 where a texture is at least the value, else 0
};

/// What the (s, t) of a texture are made of: a set of uvs of the surface, or the point in the space of the texture.
enum class TextureMappingKind : uint32_t { uv, spherical, cylindrical, planar };

enum class WrapMode : uint32_t { repeat, black, clamp, mirror };

}  // namespace ALHAZEN_CORE

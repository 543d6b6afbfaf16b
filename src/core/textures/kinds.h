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
  threshold,      ///< 1 where a texture is at least the value, else 0
};

enum class WrapMode : uint32_t { repeat, black, clamp, mirror };

}  // namespace ALHAZEN_CORE

#pragma once

// Where the coordinates of a texture come from, and how images continue past their edges.

#include <cstdint>

#include "core/math/platform.h"

namespace ALHAZEN_CORE {

/// The source of a texture's (s, t): a uv set of the surface, or the point in texture space.
enum class TextureMappingKind : uint32_t { uv, spherical, cylindrical, planar };

enum class WrapMode : uint32_t { repeat, black, clamp, mirror };

}  // namespace ALHAZEN_CORE

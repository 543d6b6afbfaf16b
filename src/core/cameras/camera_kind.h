#pragma once

// The kinds of cameras.

#include <cstdint>

#include "core/math/platform.h"

namespace ALHAZEN_CORE {

enum class CameraKind : uint32_t {
  perspective,
  orthographic,     ///< rays are parallel to z; the screen window is in units of camera space
  equirectangular,  ///< the whole sphere of directions; y is up, as in pbrt's spherical camera
  equal_area        ///< the whole sphere by the octahedral mapping
};

}  // namespace ALHAZEN_CORE

#pragma once

// The kinds of cameras.

#include <cstdint>

#include "core/math/platform.h"

namespace ALHAZEN_CORE {

enum class CameraKind : uint32_t {
  perspective,
  orthographic,     ///< rays go along z; the screen window is in units of camera space
  equirectangular,  ///< the whole sphere about the camera: as pbrt's spherical camera, y is up
  equal_area        ///< the same by the octahedral mapping
};

}  // namespace ALHAZEN_CORE

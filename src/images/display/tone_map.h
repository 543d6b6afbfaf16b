#pragma once

// From scene-referred to display-referred colours.

#include "core/math/vec.h"
#include "images/image.h"

namespace alhazen {

/// Linear sRGB in, linear sRGB in [0, 1] out. NaN and negative values become 0.
Vec3d tone_map(const Vec3d& colour, ToneMap kind);

}  // namespace alhazen

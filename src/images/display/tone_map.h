#pragma once

// Tone mapping from scene-referred to display-referred colours.

#include "core/math/vec.h"
#include "images/image.h"

namespace alhazen {

/// Maps linear sRGB to linear sRGB in [0, 1]. NaN and negative values become 0.
Vec3d tone_map(const Vec3d& colour, ToneMap kind);

}  // namespace alhazen

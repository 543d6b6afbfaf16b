#pragma once

// Colours for numbers.

#include "core/math/vec.h"

namespace alhazen {

/// Black over purple and orange to pale yellow, with a lightness that rises evenly: linear sRGB for a value in [0, 1].
Vec3d error_colour(double value);

}  // namespace alhazen

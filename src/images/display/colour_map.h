#pragma once

// A colour map for scalar values.

#include "core/math/vec.h"

namespace alhazen::impl {

/// Linear sRGB for a value in [0, 1]: from black over purple and orange to pale yellow, with uniformly rising
/// lightness.
Vec3d error_colour(double value);

}  // namespace alhazen::impl

#pragma once

// The chromaticities of white light of a colour temperature.

#include "core/math/vec.h"

namespace alhazen::impl {

inline constexpr double min_white_temperature = 1000, max_white_temperature = 25000;

/// The colour temperature of D65, in kelvin.
inline constexpr double d65_temperature = 6504;

/// CIE 1931 x and y of white light: of a black body up to 4000 K, of daylight (CIE 15) from 5000 K, and between both
/// in between. `kelvin` is from min_white_temperature to max_white_temperature.
Vec2d white_point(double kelvin);

/// The temperature, in kelvin, whose white point is the closest in CIE 1960 u and v, within the same limits.
double nearest_white_temperature(const Vec2d& xy);

}  // namespace alhazen::impl

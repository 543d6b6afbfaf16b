#pragma once

// The CIE 1931 standard observer.

#include "core/math/vec.h"

namespace alhazen::impl {

/// The range of wavelengths in nanometres over which spectra are integrated.
inline constexpr int first_visible = 360, last_visible = 830;

/// The colour matching functions (x, y, z) of the CIE 1931 2-degree observer, interpolated linearly between tabulated
/// values; zero outside the visible range.
Vec3d cie_1931(double nanometres);

}  // namespace alhazen::impl

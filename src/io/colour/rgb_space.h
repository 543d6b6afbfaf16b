#pragma once

// Colour spaces of three primaries, and their way to linear sRGB.

#include <string>

#include "core/math/vec.h"

namespace alhazen {

/// Linear sRGB of CIE XYZ, whose Y = 1 with the chromaticity of D65 is (1, 1, 1). May be negative: out of gamut.
Vec3d xyz_to_srgb(Vec3d xyz);

/// True for the names that to_srgb knows: srgb, rec2020, dci-p3 (with the white D65), aces2065-1.
bool is_rgb_space(const std::string& name);

/// Linear sRGB of linear `rgb` of the space of that name. White stays white: what has another white than D65
/// (aces2065-1) is adapted to it by the method of Bradford. Throws InputError where the name is not known.
Vec3d to_srgb(const std::string& space, Vec3d rgb);

}  // namespace alhazen

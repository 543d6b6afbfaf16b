#pragma once

// The RGB colour spaces that a scene file can name.

#include <optional>
#include <string>

#include "core/math/vec.h"

namespace alhazen::pbrt {

enum class ColourSpace { srgb, dci_p3, rec2020, aces2065_1 };

std::optional<ColourSpace> colour_space_named(const std::string& name);

/// Linear RGB of `space` to linear sRGB. White goes to white: for ACES, whose white is D60, by Bradford adaptation.
Vec3d to_srgb(ColourSpace space, const Vec3d& rgb);

/// CIE XYZ, with white D65, to linear sRGB.
Vec3d srgb_from_xyz(const Vec3d& xyz);

}  // namespace alhazen::pbrt

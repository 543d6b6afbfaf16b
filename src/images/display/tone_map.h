#pragma once

// Tone mapping from scene-referred to display-referred colours.

#include <string>

#include "core/math/vec.h"
#include "images/image.h"

namespace alhazen::impl {

/// Maps linear sRGB to linear sRGB in [0, 1]. NaN and negative values become 0.
///
/// Each channel of a grey never decreases where the grey becomes brighter. The results have the same bits on every
/// machine, since a noise target may depend on them (images/display/display_error.h).
Vec3d tone_map(const Vec3d& colour, ToneMap kind);

/// The tone map of that name; an empty name is `none`. Throws InputError that lists the names.
ToneMap tone_map_named(const std::string& name);
std::string to_string(ToneMap kind);

/// All names, with commas between them and "or" before the last.
std::string tone_map_names();

/// AgX of non-negative colours, in [0, 1] (agx.cpp).
Vec3d agx(const Vec3d& colour);

}  // namespace alhazen::impl

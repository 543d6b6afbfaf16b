#pragma once

// The pixel filters by their names in scene files and settings.

#include <map>
#include <string>

#include "scene/scene.h"

namespace alhazen::impl {

/// Each filter with the radii that pbrt-v4 gives it where a file does not.
const std::map<std::string, Filter>& named_filters();

/// Radii of filters are above 0 and at most this many pixels.
inline constexpr double max_filter_radius = 64;

}  // namespace alhazen::impl

#pragma once

// When the shutter of a scene that describes motion is open.

#include <optional>

#include "scene/scene.h"

namespace alhazen::impl {

/// Opens the shutter at `time`, in seconds, instead of when the scene says, and for `seconds` instead of for as long as
/// that. The brightness stays what the scene says. A moving camera is placed where it is at those times. Throws
/// InputError if `time` is given and nothing in the scene moves.
void set_shutter(Scene& scene, std::optional<double> time, std::optional<double> seconds);

}  // namespace alhazen::impl

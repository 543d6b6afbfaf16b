#pragma once

#include "scene/scene.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

/// Warns of a scene that is too small for where it is: where coordinates are rounded by more than a thousandth of its
/// size, the camera that sees it is not where it should be, and the image may be black.
void warn_of_far_scene(const Scene& scene, Diagnostics& diagnostics);

}  // namespace alhazen::impl

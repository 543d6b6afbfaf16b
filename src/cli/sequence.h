#pragma once

// `alhazen render` with --frames or --turntable: a sequence of images, and videos of them.

#include "cli/render_options.h"

namespace alhazen::impl {

/// Renders the frames that are not there yet, and returns the exit code. What stays the same in all frames is read and
/// built once, where the camera alone moves; otherwise each frame reads the scene again. A frame has the same bits
/// whichever others are rendered.
int render_sequence(RenderOptions& options);

}  // namespace alhazen::impl

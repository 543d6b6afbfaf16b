#pragma once

// The images that the library returns.

#include "alhazen/alhazen.h"
#include "render/renderer.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

/// With the warnings so far.
RenderedImage rendered_image(const Rendering& rendering, const Diagnostics& diagnostics);

}  // namespace alhazen::impl

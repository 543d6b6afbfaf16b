#pragma once

// The last steps of every render of the public interface.

#include "alhazen/alhazen.h"
#include "pipeline/load_scene.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

/// Renders a scene to which `settings` have been applied.
RenderedImage rendered_image(LoadedScene&& loaded, const Settings& settings, const ProgressFunction& progress,
                             Diagnostics& diagnostics);

}  // namespace alhazen::impl

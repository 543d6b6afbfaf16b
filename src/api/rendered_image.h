#pragma once

// The last steps of every render of the public interface.

#include "alhazen/alhazen.h"
#include "pipeline/load_scene.h"
#include "render/renderer.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

/// Throws InputError for settings that select what is read from a file: for a scene in memory they come too late.
void refuse_reading_settings(const Settings& settings);

/// Renders a scene to which `settings` have been applied.
RenderedImage rendered_image(LoadedScene&& loaded, const Settings& settings, const ProgressFunction& progress,
                             Diagnostics& diagnostics);

/// What is rendered so far, with the warnings so far.
RenderedImage rendered_image(const Rendering& rendering, const Diagnostics& diagnostics);

}  // namespace alhazen::impl

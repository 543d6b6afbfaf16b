#pragma once

// The last steps of every render of the public interface.

#include <string>

#include "alhazen/alhazen.h"
#include "api/building.h"
#include "images/image.h"
#include "pipeline/load_scene.h"
#include "render/renderer.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

/// Throws InputError for settings that select what is read from a file: for a scene in memory they come too late.
void refuse_reading_settings(const Settings& settings);

/// Without samples: what a render returns that was ended while its scene was read or built.
RenderedImage empty_image(const Diagnostics& diagnostics);

/// Returns the image that `render` returns, or an empty one where the listener or a stop ends the task before it.
template <class Render>
RenderedImage image_for_caller(Listener& listener, const Diagnostics& diagnostics, const Render& render) {
  return listener.for_caller([&] {
    try {
      return render();
    } catch (const Cancelled&) {
      if (listener.has_thrown()) throw;
      return empty_image(diagnostics);
    }
  });
}

/// Renders a scene to which `settings` have been applied.
RenderedImage rendered_image(LoadedScene&& loaded, const Settings& settings, const ProgressFunction& progress,
                             Diagnostics& diagnostics);

/// An image of planes alone.
RenderedImage rendered_image(Image&& planes);

/// Throws InputError, which begins with `name`, if an image has no pixels, or a plane not one value for each.
void check_planes(const RenderedImage& image, const std::string& name);

/// What is rendered so far, with the warnings so far.
RenderedImage rendered_image(const Rendering& rendering, const Diagnostics& diagnostics);

}  // namespace alhazen::impl

#include "api/rendered_image.h"

#include <algorithm>
#include <string>
#include <utility>

#include "api/option_names.h"
#include "pipeline/write_outputs.h"

namespace alhazen::impl {

void refuse_reading_settings(const Settings& settings) {
  const auto refuse = [](bool is_given, const char* name) {
    if (is_given)
      throw InputError("the setting '" + std::string(name) +
                       "' is about reading a file: give it to Scene::load instead");
  };
  refuse(!settings.camera.empty(), "camera");
  refuse(!settings.variant.empty(), "variant");
  refuse(!settings.animation.empty(), "animation");
  refuse(settings.animation_time.has_value(), "animation_time");
  refuse(settings.shutter.has_value(), "shutter");
  refuse(!settings.definitions.empty(), "definitions");
}

RenderedImage empty_image(const Diagnostics& diagnostics) {
  RenderedImage image;
  image.complete = false;
  image.warnings = with_field_names(diagnostics.public_warnings());
  return image;
}

RenderedImage rendered_image(LoadedScene&& loaded, const Settings& settings, const ProgressFunction& progress,
                             Diagnostics& diagnostics) {
  const RenderSettings resolved = resolve_settings(settings, loaded.scene);
  const Rendering rendering =
      render_scene(std::move(loaded.scene), resolved, loaded.seconds, RenderEvents{progress, {}, {}}, diagnostics);
  return rendered_image(rendering, diagnostics);
}

RenderedImage rendered_image(Image&& planes) {
  RenderedImage image;
  image.width = planes.width;
  image.height = planes.height;
  image.channels = std::move(planes.channels);
  image.planes = std::move(planes.planes);
  return image;
}

void check_planes(const RenderedImage& image, const std::string& name) {
  const size_t pixels = static_cast<size_t>(std::max(image.width, 0)) * static_cast<size_t>(std::max(image.height, 0));
  if (pixels == 0 || image.planes.size() != image.channels.size() ||
      std::any_of(image.planes.begin(), image.planes.end(), [&](const auto& plane) { return plane.size() != pixels; }))
    throw InputError(name + ": it has no pixels, or its planes do not hold width * height values each");
}

RenderedImage rendered_image(const Rendering& rendering, const Diagnostics& diagnostics) {
  RenderedImage image;
  // A film without samples is black, and would look like an image.
  if (rendering.has_samples()) {
    image = rendered_image(image_of(rendering.source()));
    const RenderSettings& settings = rendering.statistics.settings;
    image.x = settings.window.x0;
    image.y = settings.window.y0;
    image.full_width = settings.width;
    image.full_height = settings.height;
    image.metadata = image_metadata(rendering, true);
  }
  const RenderStatistics& statistics = rendering.statistics;
  image.samples = statistics.mean_samples;
  image.seconds = statistics.render_seconds;
  image.complete = statistics.complete;
  image.denoiser = statistics.denoiser;
  image.quality = statistics.settings.asked.quality;
  if (statistics.settings.asked.noise > 0)
    image.noise = ReachedNoise{statistics.noise.noise, statistics.noise.below, statistics.noise.mean_samples};
  image.warnings = with_field_names(diagnostics.public_warnings());
  return image;
}

}  // namespace alhazen::impl

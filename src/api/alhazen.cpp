#include "alhazen/alhazen.h"

#include "pipeline/load_scene.h"
#include "render/renderer.h"
#include "util/thread_limit.h"

namespace ALHAZEN_NAMESPACE {

const float* RenderedImage::plane(const std::string& channel) const {
  for (size_t i = 0; i < channels.size(); ++i)
    if (channels[i] == channel) return planes[i].data();
  return nullptr;
}

RenderedImage render(const std::string& scene_file, const Settings& settings, const ProgressFunction& progress) {
  using namespace impl;
  const ThreadDefaults defaults;
  Diagnostics diagnostics;
  LoadedScene loaded = load_scene(scene_file, settings, diagnostics);
  const RenderSettings resolved = resolve_settings(settings, loaded.scene);
  const Rendering rendering =
      render_scene(std::move(loaded.scene), resolved, loaded.seconds, RenderEvents{progress, {}, {}}, diagnostics);
  RenderedImage image;
  // A film without samples is black, and would look like an image.
  if (rendering.has_samples()) {
    Image means = image_of(rendering.source());
    image.width = means.width;
    image.height = means.height;
    image.channels = std::move(means.channels);
    image.planes = std::move(means.planes);
  }
  const RenderStatistics& statistics = rendering.statistics;
  image.complete = statistics.complete;
  image.denoiser = statistics.denoiser;
  image.quality = statistics.settings.asked.quality;
  if (statistics.settings.asked.noise > 0)
    image.noise = ReachedNoise{statistics.noise.noise, statistics.noise.below, statistics.noise.mean_samples};
  for (const Diagnostics::Warning& warning : diagnostics.warnings()) image.warnings.push_back(warning.to_string());
  return image;
}

}  // namespace ALHAZEN_NAMESPACE

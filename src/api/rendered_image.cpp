#include "api/rendered_image.h"

#include <utility>

#include "images/image.h"

namespace alhazen::impl {

RenderedImage rendered_image(const Rendering& rendering, const Diagnostics& diagnostics) {
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

}  // namespace alhazen::impl

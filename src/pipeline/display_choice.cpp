#include "pipeline/display_choice.h"

#include <algorithm>
#include <array>

#include "images/display/tone_map.h"
#include "images/display/white_balance.h"

namespace alhazen::impl {

namespace {

/// How much of each pixel is covered by surfaces.
std::vector<float> coverage_of(const Rendering& rendering) {
  return std::visit(
      [](const auto& film) {
        const auto planes = film->view();
        std::vector<float> coverage(static_cast<size_t>(film->window().pixels()));
        for (size_t i = 0; i < coverage.size(); ++i)
          coverage[i] = std::clamp(static_cast<float>(planes.coverage(i)), 0.0f, 1.0f);
        return coverage;
      },
      rendering.film);
}

/// Calls `visit(x, y, radiance)` for every pixel.
template <class Visit>
void visit_pixels(const ImageSource& source, const Visit& visit) {
  const std::array<size_t, 3> channels = rgb_channels("an image for a display", source);
  const size_t width = static_cast<size_t>(source.width);
  std::vector<float> row(source.channels.size() * width);
  for (int y = 0; y < source.height; ++y) {
    source.fill_row(y, row);
    for (size_t x = 0; x < width; ++x) {
      const auto value = [&](size_t c) { return static_cast<double>(row[channels[c] * width + x]); };
      visit(static_cast<int>(x), y, Vec3d{value(0), value(1), value(2)});
    }
  }
}

}  // namespace

DisplayStatistics choose_display(const Rendering& rendering, const DisplayChoice& choice, WriteOptions& how) {
  const bool meters = choice.exposure != ExposureRule::given;
  if (meters || choice.estimates_white) {
    const ImageSource source = rendering.source();
    const std::vector<float> coverage = coverage_of(rendering);
    const auto coverage_at = [&](int x, int y) {
      const size_t i = static_cast<size_t>(y) * static_cast<size_t>(source.width) + static_cast<size_t>(x);
      return static_cast<double>(coverage[i]);
    };
    // Where the background is transparent, colours are premultiplied.
    const bool has_alpha = rendering.statistics.settings.has_alpha;
    const auto straight = [&](int x, int y, const Vec3d& radiance) {
      const double alpha = coverage_at(x, y);
      return has_alpha && alpha > 0 ? radiance / alpha : radiance;
    };
    ExposureMeter meter(source.width, source.height, true);
    visit_pixels(source, [&](int x, int y, const Vec3d& radiance) {
      meter.add(x, y, straight(x, y, radiance), coverage_at(x, y));
    });
    if (meters) how.exposure = meter.exposure(choice.exposure);
    const double brightest = meter.quantile(0.95);
    if (choice.estimates_white && brightest > 0) {
      LightColourEstimate light(brightest);
      visit_pixels(source, [&](int x, int y, const Vec3d& radiance) {
        light.add(straight(x, y, radiance), meter.weight(x, y, coverage_at(x, y)));
      });
      how.white_temperature = light.temperature();
    }
  }
  const bool is_metered = choice.exposure == ExposureRule::automatic || (meters && how.exposure != 0);
  return {how.exposure, is_metered, how.white_temperature, choice.estimates_white, to_string(how.tone_map)};
}

}  // namespace alhazen::impl

// What a render leaves, as rows of an image.

#include <algorithm>

#include "render/noisy_image.h"
#include "render/renderer.h"

namespace alhazen::impl {

bool Rendering::has_samples() const {
  return std::visit([](const auto& any_film) { return any_film->max_samples() > 0; }, film);
}

ImageSource Rendering::source() const {
  ImageSource source = std::visit(
      [](const auto& any_film) {
        const auto* planes = any_film.get();
        return ImageSource{planes->window().width(), planes->window().height(), planes->channels(),
                           [planes](int y, std::span<float> row) { planes->resolve_row(y, row); }};
      },
      film);
  const size_t width = static_cast<size_t>(source.width), count = source.channels.size();
  const bool keeps_noisy = statistics.settings.aovs.noisy;
  if (keeps_noisy) source.channels.insert(source.channels.end(), {"noisy.R", "noisy.G", "noisy.B"});
  if (denoised.empty() && !keeps_noisy) return source;
  source.fill_row = [this, width, count, keeps_noisy, film_row = source.fill_row](int y, std::span<float> row) {
    film_row(y, row);
    if (keeps_noisy) std::copy_n(row.begin(), 3 * width, row.begin() + static_cast<std::ptrdiff_t>(count * width));
    if (denoised.empty()) return;
    for (size_t i = 0; i < 3 * width; ++i)
      row[i % 3 * width + i / 3] = denoised[static_cast<size_t>(y) * 3 * width + i];
  };
  return source;
}

std::map<std::string, std::string> Rendering::layer_metadata() const {
  return std::visit(
      [&](const auto& any_film) {
        return impl::layer_metadata(any_film->view(), static_cast<size_t>(any_film->window().pixels()),
                                    statistics.settings.aovs, any_film->scene());
      },
      film);
}

NoisyImage Rendering::noisy_image() const {
  return std::visit([](const auto& any_film) { return make_noisy_image(*any_film); }, film);
}

}  // namespace alhazen::impl

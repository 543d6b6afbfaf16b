#include "alhazen/compare.h"

#include <utility>

#include "alhazen/error.h"
#include "api/rendered_image.h"
#include "images/image.h"
#include "images/metrics/compare.h"
#include "images/metrics/image_parts.h"

namespace ALHAZEN_NAMESPACE {

namespace {

/// Checks the sizes of the planes, and copies those that are compared. `name` is for messages.
impl::Image compared_part(const RenderedImage& image, const char* name, const CompareOptions& options) {
  impl::check_planes(image, name);
  impl::Image part{image.width, image.height, {}, {}};
  const bool is_colour = image.plane("R") && image.plane("G") && image.plane("B");
  for (size_t c = 0; c < image.channels.size(); ++c) {
    const std::string& channel = image.channels[c];
    const bool is_wanted = options.layer.empty()
                               ? !is_colour || channel == "R" || channel == "G" || channel == "B"
                               : channel.size() > options.layer.size() && channel.starts_with(options.layer + ".");
    if (!is_wanted) continue;
    part.channels.push_back(channel);
    part.planes.push_back(image.planes[c]);
  }
  if (!options.layer.empty()) {
    if (part.channels.empty()) part.channels = image.channels;  // the message lists them; there are no planes
    part = impl::layer_of(part, options.layer, name);
  }
  if (options.region) part = impl::region_of(part, *options.region);
  return options.reduce == 1 ? part : impl::reduced(part, options.reduce);
}

}  // namespace

Comparison compare(const RenderedImage& a, const RenderedImage& b, const CompareOptions& options) {
  const impl::Image part_a = compared_part(a, "a", options), part_b = compared_part(b, "b", options);
  impl::Plane<float> map(0, 0);
  const impl::ImageDifference d = impl::compare_images(part_a, part_b, map);
  return {d.mse,
          d.rmse,
          d.relmse,
          d.relmse_trimmed,
          d.psnr,
          d.ssim,
          d.flip,
          d.mean_a,
          d.mean_b,
          d.max_abs,
          d.nonfinite_a,
          d.nonfinite_b,
          d.nonfinite_in_one,
          d.compared,
          part_a.width,
          part_a.height,
          std::move(map.values)};
}

RenderedImage heat_map(const Comparison& comparison) {
  const size_t pixels = comparison.flip_map.size();
  if (comparison.width <= 0 || comparison.height <= 0 ||
      pixels != static_cast<size_t>(comparison.width) * static_cast<size_t>(comparison.height))
    throw InputError("comparison: its flip_map does not hold width * height values");
  impl::Plane<float> map(static_cast<size_t>(comparison.width), static_cast<size_t>(comparison.height));
  map.values = comparison.flip_map;
  return impl::rendered_image(impl::error_colours(map));
}

}  // namespace ALHAZEN_NAMESPACE

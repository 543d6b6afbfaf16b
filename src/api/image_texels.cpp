#include "api/image_texels.h"

#include <algorithm>
#include <cmath>

#include "api/arguments.h"
#include "images/image.h"

namespace alhazen::impl {

namespace {

constexpr int max_texels = 1 << 30;

/// Copies `kept` of the channels of each texel, from `first` on.
template <class Value>
std::vector<Value> channels_of(std::span<const Value> values, size_t channels, size_t first, size_t kept) {
  std::vector<Value> result;
  result.reserve(values.size() / channels * kept);
  for (size_t texel = 0; texel < values.size(); texel += channels)
    for (size_t c = 0; c < kept; ++c) result.push_back(values[texel + first + c]);
  return result;
}

}  // namespace

ImageTexels image_of_pixels(const Pixels& pixels) {
  if (pixels.width < 1) refuse_argument("width", "must be 1 or more, not " + std::to_string(pixels.width));
  if (pixels.height < 1) refuse_argument("height", "must be 1 or more, not " + std::to_string(pixels.height));
  if (pixels.channels != 1 && pixels.channels != 3 && pixels.channels != 4)
    refuse_argument("channels", "must be 1, 3 or 4, not " + std::to_string(pixels.channels));
  if (int64_t{pixels.width} * pixels.height > max_texels)
    refuse_argument("width", "and 'height' give more than 2^30 texels");
  if (pixels.takes_alpha && pixels.channels != 4)
    refuse_argument("takes_alpha", "needs 4 channels, not " + std::to_string(pixels.channels));
  if (pixels.bytes.empty() == pixels.floats.empty())
    refuse_argument("bytes", "or 'floats' must hold the values, and only one of them");
  const Encoding encoding = same_kind<Encoding>("encoding", pixels.encoding, 2);
  const size_t channels = static_cast<size_t>(pixels.channels);
  const size_t values = static_cast<size_t>(pixels.width) * static_cast<size_t>(pixels.height) * channels;
  const bool has_bytes = !pixels.bytes.empty();
  if (const size_t given = has_bytes ? pixels.bytes.size() : pixels.floats.size(); given != values)
    refuse_argument(has_bytes ? "bytes" : "floats", "must have width * height * channels = " + std::to_string(values) +
                                                        " values, not " + std::to_string(given));
  for (const float value : pixels.floats)
    if (!std::isfinite(value)) refuse_argument("floats", "holds a value that is infinite or not a number");
  const size_t kept = channels == 1 || pixels.takes_alpha ? 1 : 3, first = pixels.takes_alpha ? 3 : 0;
  ImageTexels image;
  image.width = pixels.width;
  image.height = pixels.height;
  image.channels = static_cast<int>(kept);
  image.srgb = has_bytes && encoding == Encoding::srgb && !pixels.takes_alpha;
  image.name = pixels.name;
  if (has_bytes)
    image.bytes = channels_of(pixels.bytes, channels, first, kept);
  else
    image.floats = channels_of(pixels.floats, channels, first, kept);
  return image;
}

ImageTexels light_map_of_pixels(const Pixels& pixels) {
  const ImageTexels image = image_of_pixels(pixels);
  ImageTexels map;
  map.width = image.width;
  map.height = image.height;
  map.srgb = false;
  map.name = image.name;
  const auto value_at = [&](size_t i) {
    if (!image.floats.empty()) return std::max(image.floats[i], 0.0f);
    const double value = static_cast<double>(image.bytes[i]) / 255;
    return static_cast<float>(image.srgb ? srgb_decode(value) : value);
  };
  const size_t texels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  map.floats.reserve(3 * texels);
  for (size_t i = 0; i < texels; ++i)
    for (size_t c = 0; c < 3; ++c) map.floats.push_back(value_at(image.channels == 1 ? i : 3 * i + c));
  return map;
}

Pixels pixels_of(const ImageTexels& image) {
  return {.width = image.width,
          .height = image.height,
          .channels = image.channels,
          .bytes = image.bytes,
          .floats = image.floats,
          .encoding = image.floats.empty() && image.srgb ? Encoding::srgb : Encoding::linear,
          .takes_alpha = false,
          .name = image.name};
}

}  // namespace alhazen::impl

// PNG in memory, by libpng's simplified interface.

#include "images/codecs/encode_png.h"

#include <png.h>

#include <cmath>
#include <string>

#include "images/codecs/decoders.h"

namespace alhazen::impl {

namespace {

uint8_t encoded(float linear) {
  const double value = std::isnan(linear) ? 0 : std::min(std::max(static_cast<double>(linear), 0.0), 1.0);
  return static_cast<uint8_t>(std::floor(255 * srgb_encode(value) + 0.5));
}

}  // namespace

std::vector<uint8_t> encode_png(const Image& image) {
  const ColourChannels channels = colour_channels(image);
  if (!channels) throw InputError("an image " + channels.fault + ", so it cannot be shown");
  const size_t count = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  std::vector<uint8_t> pixels(3 * count);
  for (size_t c = 0; c < 3; ++c) {
    const std::vector<float>& plane = image.planes[static_cast<size_t>(channels.rgb[c])];
    for (size_t i = 0; i < count; ++i) pixels[3 * i + c] = encoded(plane[i]);
  }
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::vector<uint8_t> bytes(size);
  if (png_image_write_to_memory(&png, bytes.data(), &size, 0, pixels.data(), 0, nullptr) == 0)
    throw RenderError(std::string("cannot make a PNG: ") + png.message);
  bytes.resize(size);
  return bytes;
}

}  // namespace alhazen::impl

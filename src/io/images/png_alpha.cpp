#include "io/images/png_alpha.h"

#include <png.h>

#include <vector>

#include "io/images/input_file.h"

namespace alhazen {

std::optional<ImageTexels> decode_png_alpha(const std::string& path, std::span<const uint8_t> bytes) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  const auto fail = [&] {
    const std::string message = image.message;
    png_image_free(&image);
    throw_malformed(path, "not a readable PNG file: " + message);
  };
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) fail();
  if ((image.format & PNG_FORMAT_FLAG_ALPHA) == 0) {
    png_image_free(&image);
    return std::nullopt;
  }
  const uint64_t width = image.width, height = image.height;
  try {
    check_size(path, static_cast<int64_t>(width), static_cast<int64_t>(height));
    check_plausible(path, width * height, bytes.size());
  } catch (...) {
    png_image_free(&image);
    throw;
  }
  image.format = PNG_FORMAT_RGBA;
  std::vector<uint8_t> samples(PNG_IMAGE_SIZE(image));
  if (png_image_finish_read(&image, nullptr, samples.data(), 0, nullptr) == 0) fail();
  ImageTexels texels{static_cast<int>(width), static_cast<int>(height), {}, {}, false, path};
  texels.bytes.resize(samples.size() / 4 * 3);
  for (size_t i = 0; i < samples.size() / 4; ++i)
    texels.bytes[3 * i] = texels.bytes[3 * i + 1] = texels.bytes[3 * i + 2] = samples[4 * i + 3];
  return texels;
}

}  // namespace alhazen

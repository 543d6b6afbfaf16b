#include "images/read_scalar_texture.h"

#include <algorithm>
#include <array>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "images/codecs/decoders.h"
#include "images/codecs/image_bytes.h"

namespace alhazen::impl {

namespace {

/// Decodes 8-bit values by a table, so that the curve is evaluated 256 times, not once per texel.
class ByteDecoder {
 public:
  explicit ByteDecoder(bool srgb) {
    for (size_t i = 0; i < 256; ++i) {
      const double encoded = static_cast<double>(i) / 255;
      values_[i] = srgb ? srgb_decode(encoded) : encoded;
    }
  }
  double operator()(uint8_t byte) const { return values_[byte]; }

 private:
  std::array<double, 256> values_{};
};

Vec3d texel(const ImageTexels& image, const ByteDecoder& decode, size_t index) {
  if (image.floats.empty())
    return {decode(image.bytes[3 * index]), decode(image.bytes[3 * index + 1]), decode(image.bytes[3 * index + 2])};
  return {static_cast<double>(image.floats[3 * index]), static_cast<double>(image.floats[3 * index + 1]),
          static_cast<double>(image.floats[3 * index + 2])};
}

template <class Value>
bool is_grey(const std::vector<Value>& values) {
  for (size_t i = 0; i + 2 < values.size(); i += 3)
    if (values[i] != values[i + 1] || values[i] != values[i + 2]) return false;
  return true;
}

/// Replaces the colours by the mean of the three linear channels. Grey images keep their bytes.
void make_grey(ImageTexels& image) {
  if (image.floats.empty() ? is_grey(image.bytes) : is_grey(image.floats)) return;
  const size_t count = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  const ByteDecoder decode(image.srgb);
  std::vector<float> grey(count);
  for (size_t i = 0; i < count; ++i) {
    const Vec3d colour = texel(image, decode, i);
    grey[i] = static_cast<float>((colour.x + colour.y + colour.z) / 3);
  }
  image.channels = 1;
  image.bytes = {};
  image.floats = std::move(grey);
}

std::optional<ImageTexels> exr_alpha(const Image& image, const std::string& path) {
  const int alpha = colour_channels(image).alpha;
  if (alpha < 0) return std::nullopt;
  ImageTexels texels{image.width, image.height, {}, image.planes[static_cast<size_t>(alpha)], false, path, 1};
  return unless_opaque(std::move(texels));
}

std::optional<ImageTexels> decode_alpha(const std::string& path, ImageFormat format, std::span<const uint8_t> bytes) {
  switch (format) {
    case ImageFormat::png:
      return decode_png_alpha(path, bytes);
    case ImageFormat::tga:
      return decode_tga_alpha(path, bytes);
    case ImageFormat::bmp:
      return decode_bmp_alpha(path, bytes);
    case ImageFormat::webp:
      return decode_webp_alpha(path, bytes);
    case ImageFormat::qoi:
      return decode_qoi_alpha(path, bytes);
    case ImageFormat::exr:
    case ImageFormat::jpeg:
    case ImageFormat::hdr:
    case ImageFormat::pfm:
      break;
  }
  return std::nullopt;
}

/// The colour type of a PNG file is byte 25; 6 is RGBA.
bool pbrt_reads_alpha(ImageFormat format, std::span<const uint8_t> bytes) {
  return format == ImageFormat::qoi || (format == ImageFormat::png && bytes.size() > 25 && bytes[25] == 6);
}

ScalarTexture read_scalar(const InputPath& input, TextureEncoding encoding) {
  const std::string& path = input.name;
  const ImageFormat format = image_format(input);
  ImageTexels colours;
  if (format == ImageFormat::exr) {
    const Image image = read_exr(input);
    if (std::optional<ImageTexels> alpha = exr_alpha(image, path)) return {std::move(*alpha), true, false};
    colours = exr_texels(image, path, true);
  } else {
    const std::vector<uint8_t> bytes = read_bytes(input);
    if (std::optional<ImageTexels> alpha = decode_alpha(path, format, bytes))
      return {std::move(*alpha), true, format != ImageFormat::webp && !pbrt_reads_alpha(format, bytes)};
    colours = decode_texture(path, format, bytes, encoding);
  }
  make_grey(colours);
  return {std::move(colours), false, false};
}

}  // namespace

ScalarTexture read_scalar_texture(const InputPath& path, TextureEncoding encoding) {
  try {
    return read_scalar(path, encoding);
  } catch (const std::bad_alloc&) {
    throw TooLargeError({path.name}, "is too large for the memory of this machine");
  }
}

}  // namespace alhazen::impl

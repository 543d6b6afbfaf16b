#include "images/read_texture.h"

#include <algorithm>
#include <array>
#include <new>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "images/codecs/decoders.h"
#include "images/codecs/image_bytes.h"

namespace alhazen::impl {

ImageFormat image_format(const InputPath& input) {
  const std::string& path = input.name;
  InputFile file(input);
  if (file.size() == 0) throw_malformed(path, "the file is empty");
  std::array<char, 12> buffer{};
  const std::string_view head(buffer.data(), file.read(buffer.data(), buffer.size()));
  if (head.starts_with("\x76\x2f\x31\x01")) return ImageFormat::exr;
  if (head.starts_with("\x89PNG\r\n\x1a\n")) return ImageFormat::png;
  if (head.starts_with("\xff\xd8\xff")) return ImageFormat::jpeg;
  if (head.starts_with("#?")) return ImageFormat::hdr;
  if (head.starts_with("PF") || head.starts_with("Pf")) return ImageFormat::pfm;
  if (head.starts_with("RIFF") && head.substr(8) == "WEBP") return ImageFormat::webp;
  if (head.starts_with("qoif")) return ImageFormat::qoi;
  // The other signatures are too long to begin a TGA file by chance; "BM" is not.
  if (extension_of(path) == "tga") return ImageFormat::tga;
  if (head.starts_with("BM")) return ImageFormat::bmp;
  throw_malformed(path,
                  "is not an image of a known format; PNG, JPEG, TGA, BMP, QOI, WebP, HDR, PFM and EXR are supported");
}

bool is_opaque(const ImageTexels& texels) {
  return std::all_of(texels.bytes.begin(), texels.bytes.end(), [](uint8_t value) { return value == 255; }) &&
         std::all_of(texels.floats.begin(), texels.floats.end(), [](float value) { return value == 1; });
}

std::optional<ImageTexels> unless_opaque(ImageTexels&& alpha) {
  return is_opaque(alpha) ? std::nullopt : std::optional(std::move(alpha));
}

static void turn_to_srgb(const Chromaticities& chromaticities, std::vector<float>& rgb) {
  const SrgbFromPrimaries to_linear_srgb(chromaticities);
  if (to_linear_srgb.is_identity()) return;
  for (size_t i = 0; i + 2 < rgb.size(); i += 3) {
    const Vec3d colour =
        to_linear_srgb({static_cast<double>(rgb[i]), static_cast<double>(rgb[i + 1]), static_cast<double>(rgb[i + 2])});
    rgb[i] = static_cast<float>(colour.x);
    rgb[i + 1] = static_cast<float>(colour.y);
    rgb[i + 2] = static_cast<float>(colour.z);
  }
}

ImageTexels exr_texels(const Image& image, const std::string& path, bool is_data) {
  const ColourChannels channels = colour_channels(image);
  if (!channels) throw_malformed(path, channels.fault);
  ImageTexels texels{image.width, image.height, {}, {}, false, path};
  const size_t count = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  texels.floats.resize(3 * count);
  for (size_t c = 0; c < 3; ++c) {
    const std::vector<float>& plane = image.planes[static_cast<size_t>(channels.rgb[c])];
    for (size_t i = 0; i < count; ++i) texels.floats[3 * i + c] = plane[i];
  }
  if (is_data || !image.chromaticities || channels.rgb[0] == channels.rgb[1]) return texels;
  try {
    turn_to_srgb(*image.chromaticities, texels.floats);
  } catch (const InputError& error) {
    throw_malformed(path, error.what());
  }
  return texels;
}

namespace {

ImageTexels decode_format(const std::string& path, ImageFormat format, std::span<const uint8_t> bytes,
                          TextureEncoding encoding) {
  switch (format) {
    case ImageFormat::png:
      return decode_png(path, bytes, encoding != TextureEncoding::linear);
    case ImageFormat::jpeg:
      return decode_jpeg(path, bytes);
    case ImageFormat::tga:
      return decode_tga(path, bytes);
    case ImageFormat::bmp:
      return decode_bmp(path, bytes);
    case ImageFormat::hdr:
      return decode_hdr(path, bytes);
    case ImageFormat::webp:
      return decode_webp(path, bytes);
    case ImageFormat::qoi:
      return decode_qoi(path, bytes);
    case ImageFormat::pfm:
      return decode_pfm(path, bytes);
    case ImageFormat::exr:
      break;
  }
  throw std::logic_error("EXR files are read by read_exr");
}

}  // namespace

ImageTexels decode_texture(const std::string& path, ImageFormat format, std::span<const uint8_t> bytes,
                           TextureEncoding encoding) {
  ImageTexels texels = decode_format(path, format, bytes, encoding);
  texels.srgb = texels.srgb && !texels.bytes.empty() && encoding != TextureEncoding::linear;
  return texels;
}

ImageTexels read_texture(const InputPath& input, TextureEncoding encoding) {
  const std::string& path = input.name;
  try {
    const ImageFormat format = image_format(input);
    if (format == ImageFormat::exr) return exr_texels(read_exr(input), path, encoding == TextureEncoding::data);
    return decode_texture(path, format, read_bytes(input),
                          encoding == TextureEncoding::data ? TextureEncoding::linear : encoding);
  } catch (const std::bad_alloc&) {
    throw TooLargeError({path}, "is too large for the memory of this machine");
  }
}

}  // namespace alhazen::impl

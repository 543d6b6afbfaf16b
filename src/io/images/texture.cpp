#include "io/images/texture.h"

#include <algorithm>
#include <array>
#include <new>
#include <string_view>

#include "io/images/decoders.h"
#include "io/images/input_file.h"

namespace alhazen {

PictureFormat picture_format(const InputPath& input) {
  const std::string& path = input.name;
  InputFile file(input);
  if (file.size() == 0) throw_malformed(path, "the file is empty");
  std::array<char, 8> buffer{};
  const std::string_view head(buffer.data(), file.read(buffer.data(), buffer.size()));
  if (head.starts_with("\x76\x2f\x31\x01")) return PictureFormat::exr;
  if (head.starts_with("\x89PNG\r\n\x1a\n")) return PictureFormat::png;
  if (head.starts_with("\xff\xd8\xff")) return PictureFormat::jpeg;
  if (head.starts_with("#?")) return PictureFormat::hdr;
  if (head.starts_with("PF") || head.starts_with("Pf")) return PictureFormat::pfm;
  // The other signatures are long enough never to begin a TGA; "BM" is not.
  if (extension_of(path) == "tga") return PictureFormat::tga;
  if (head.starts_with("BM")) return PictureFormat::bmp;
  throw_malformed(path, "is not a picture of a known kind; PNG, JPEG, TGA, BMP, HDR, PFM and EXR are");
}

namespace {

ImageTexels exr_texels(const InputPath& input) {
  const std::string& path = input.name;
  const Image image = read_exr(input);
  int rgb[3];
  if (!colour_channels(image, rgb))
    throw_malformed(path, "has neither channels R, G, B nor grey in Y or a single channel");
  ImageTexels texels{image.width, image.height, {}, {}, false, path};
  const size_t count = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  texels.floats.resize(3 * count);
  for (size_t c = 0; c < 3; ++c) {
    const std::vector<float>& plane = image.planes[static_cast<size_t>(rgb[c])];
    for (size_t i = 0; i < count; ++i) texels.floats[3 * i + c] = plane[i];
  }
  return texels;
}

ImageTexels decode(const InputPath& input, TextureEncoding encoding) {
  const std::string& path = input.name;
  const PictureFormat format = picture_format(input);
  if (format == PictureFormat::exr) return exr_texels(input);
  const std::vector<uint8_t> bytes = read_bytes(input);
  switch (format) {
    case PictureFormat::png:
      return decode_png(path, bytes, encoding != TextureEncoding::linear);
    case PictureFormat::jpeg:
      return decode_jpeg(path, bytes);
    case PictureFormat::tga:
      return decode_tga(path, bytes);
    case PictureFormat::bmp:
      return decode_bmp(path, bytes);
    case PictureFormat::hdr:
      return decode_hdr(path, bytes);
    default:
      return decode_pfm(path, bytes);
  }
}

}  // namespace

ImageTexels read_texture(const InputPath& path, TextureEncoding encoding) {
  try {
    ImageTexels texels = decode(path, encoding);
    texels.srgb = !texels.bytes.empty() && encoding != TextureEncoding::linear;
    return texels;
  } catch (const std::bad_alloc&) {
    throw_malformed(path.name, "is too large for the memory of this machine");
  }
}

}  // namespace alhazen

// Reads WebP by libwebp.

#include <utility>

#include "images/codecs/decoders.h"
#include "images/codecs/image_bytes.h"

#ifdef ALHAZEN_WITH_WEBP
#include <webp/decode.h>
#endif

namespace alhazen::impl {

#ifdef ALHAZEN_WITH_WEBP

namespace {

struct Decoded {
  ImageTexels texels;  ///< without samples
  std::vector<uint8_t> rgba;
  bool has_alpha = false;
};

Decoded decode(const std::string& path, std::span<const uint8_t> bytes) {
  WebPBitstreamFeatures features{};
  if (WebPGetFeatures(bytes.data(), bytes.size(), &features) != VP8_STATUS_OK)
    throw_malformed(path, "not a readable WebP file");
  if (features.has_animation != 0) throw_malformed(path, "animated WebP images are not supported");
  check_size(path, features.width, features.height);
  const uint64_t pixels = static_cast<uint64_t>(features.width) * static_cast<uint64_t>(features.height);
  check_plausible(path, pixels, bytes.size());
  Decoded result{{features.width, features.height, {}, {}, true, path}, {}, features.has_alpha != 0};
  result.rgba.resize(4 * pixels);
  if (WebPDecodeRGBAInto(bytes.data(), bytes.size(), result.rgba.data(), result.rgba.size(), 4 * features.width) ==
      nullptr)
    throw_malformed(path, "not a readable WebP file: its image is damaged");
  return result;
}

/// Channels `first` to `first + count` of the four.
ImageTexels texels_of(Decoded&& decoded, size_t first, size_t count) {
  const std::vector<uint8_t>& rgba = decoded.rgba;
  decoded.texels.bytes.resize(rgba.size() / 4 * count);
  for (size_t i = 0; i < rgba.size() / 4; ++i)
    for (size_t c = 0; c < count; ++c) decoded.texels.bytes[count * i + c] = rgba[4 * i + first + c];
  return std::move(decoded.texels);
}

}  // namespace

ImageTexels decode_webp(const std::string& path, std::span<const uint8_t> bytes) {
  return texels_of(decode(path, bytes), 0, 3);
}

std::optional<ImageTexels> decode_webp_alpha(const std::string& path, std::span<const uint8_t> bytes) {
  Decoded decoded = decode(path, bytes);
  if (!decoded.has_alpha) return std::nullopt;
  ImageTexels alpha = texels_of(std::move(decoded), 3, 1);
  alpha.srgb = false;
  alpha.channels = 1;
  return unless_opaque(std::move(alpha));
}

#else

ImageTexels decode_webp(const std::string& path, std::span<const uint8_t>) {
  throw InputError({path},
                   "the program was built without libwebp-dev, so WebP images are not supported: convert it to PNG "
                   "or JPEG, or build with that library");
}

std::optional<ImageTexels> decode_webp_alpha(const std::string& path, std::span<const uint8_t> bytes) {
  return decode_webp(path, bytes);
}

#endif

}  // namespace alhazen::impl

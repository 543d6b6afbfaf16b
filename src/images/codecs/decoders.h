#pragma once

// The decoders of the formats, from the bytes of a file to texels. Each throws InputError if it cannot decode all of
// the file; `path` is for messages and the name of the texels. `srgb` of the result is true for bytes, unless the file
// says that they are linear (QOI).
//
// The decoders of alpha return one linear channel, or nothing if the file has no alpha or if it is 1 everywhere.

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "files/input_file.h"
#include "images/image.h"
#include "images/read_texture.h"
#include "scene/scene.h"

namespace alhazen::impl {

enum class ImageFormat { exr, png, jpeg, tga, bmp, hdr, pfm, webp, qoi };

/// Detects the format by the first bytes, whatever the file's name; TGA, which has no signature, by the extension of
/// `path`. Throws InputError if the file is missing or in no known format.
ImageFormat image_format(const InputPath& path);

/// `decode_16_bit`: whether 16-bit values are sRGB-encoded and must be decoded, or linear already.
ImageTexels decode_png(const std::string& path, std::span<const uint8_t> bytes, bool decode_16_bit);
/// The alpha of an alpha channel, of a palette, or of the single transparent colour.
std::optional<ImageTexels> decode_png_alpha(const std::string& path, std::span<const uint8_t> bytes);
ImageTexels decode_jpeg(const std::string& path, std::span<const uint8_t> bytes);
/// Throws an error if the program was built without libwebp.
ImageTexels decode_webp(const std::string& path, std::span<const uint8_t> bytes);
std::optional<ImageTexels> decode_webp_alpha(const std::string& path, std::span<const uint8_t> bytes);
ImageTexels decode_tga(const std::string& path, std::span<const uint8_t> bytes);
/// 32-bit texels whose header declares no alpha bits nevertheless have alpha, as many programs write them, unless it is
/// 0 everywhere.
std::optional<ImageTexels> decode_tga_alpha(const std::string& path, std::span<const uint8_t> bytes);
ImageTexels decode_bmp(const std::string& path, std::span<const uint8_t> bytes);
/// The alpha of the header's mask; without masks the unused byte of 32-bit texels is alpha unless it is 0 everywhere.
std::optional<ImageTexels> decode_bmp_alpha(const std::string& path, std::span<const uint8_t> bytes);
ImageTexels decode_qoi(const std::string& path, std::span<const uint8_t> bytes);
std::optional<ImageTexels> decode_qoi_alpha(const std::string& path, std::span<const uint8_t> bytes);
ImageTexels decode_hdr(const std::string& path, std::span<const uint8_t> bytes);
ImageTexels decode_pfm(const std::string& path, std::span<const uint8_t> bytes);

/// Reads all channels of the first part that has colours (else a luminance, else any single channel, else of the first
/// part), whatever their type. The image is the data window.
/// With `all_parts`, the channels of the other parts of the same pixels follow those of the image part, whose names
/// begin with that of their part if they name no layer themselves.
Image read_exr(const InputPath& path, bool all_parts = false);

/// The channels of an image's colour: red, green, blue, or one of grey three times; and its alpha, or -1.
struct ColourChannels {
  int rgb[3] = {-1, -1, -1};
  int alpha = -1;
  std::string fault;  ///< if there are none: what the image has instead, as a predicate of "the image"

  explicit operator bool() const { return rgb[0] >= 0; }
};

/// The only channel; or those of the base layer, R, G, B before Y; or those of the only layer that has colours
/// ("NAME.R"), or of several the one called Combined, beauty, rgba or rgb; or the same for layers with Y.
ColourChannels colour_channels(const Image& image);

/// Returns whether every value of `texels` is 1.
bool is_opaque(const ImageTexels& texels);
/// `alpha`, or nothing if it is 1 everywhere.
std::optional<ImageTexels> unless_opaque(ImageTexels&& alpha);

/// The colours of an EXR image. Throws InputError if it has none. `is_data`: the values are not colours and are kept
/// unchanged; otherwise they are converted to linear sRGB if the file has other primaries.
ImageTexels exr_texels(const Image& image, const std::string& path, bool is_data);
/// The colours of an image in any other format.
ImageTexels decode_texture(const std::string& path, ImageFormat format, std::span<const uint8_t> bytes,
                           TextureEncoding encoding);

}  // namespace alhazen::impl

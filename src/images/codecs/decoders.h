#pragma once

// The decoders of single formats, from the bytes of a file to texels. Every one throws InputError on what it cannot
// decode whole; `path` is for messages and the name of the texels. `srgb` of the result is true for bytes, unless the
// file says that they are linear (QOI).
//
// Those of alpha return it in one channel, linear, and nothing where the file has none or where it is 1 everywhere.

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "files/input_file.h"
#include "images/image.h"
#include "images/read_texture.h"
#include "scene/scene.h"

namespace alhazen {

enum class PictureFormat { exr, png, jpeg, tga, bmp, hdr, pfm, webp, qoi };

/// By the first bytes of the file, whatever its name; TGA, which has no signature, by the extension of `path`.
/// Throws InputError where the file is missing or of none of these.
PictureFormat picture_format(const InputPath& path);

/// `decode_16_bit`: whether values of 16 bits are sRGB-encoded and to be decoded, or linear already.
ImageTexels decode_png(const std::string& path, std::span<const uint8_t> bytes, bool decode_16_bit);
/// Of an alpha channel, of a palette, or of the one colour that is transparent.
std::optional<ImageTexels> decode_png_alpha(const std::string& path, std::span<const uint8_t> bytes);
ImageTexels decode_jpeg(const std::string& path, std::span<const uint8_t> bytes);
/// Where the program was built with libwebp; else an error that says so.
ImageTexels decode_webp(const std::string& path, std::span<const uint8_t> bytes);
std::optional<ImageTexels> decode_webp_alpha(const std::string& path, std::span<const uint8_t> bytes);
ImageTexels decode_tga(const std::string& path, std::span<const uint8_t> bytes);
/// Texels of 32 bits whose header says that none of them are alpha have alpha all the same, as many programs write
/// them, unless it is 0 everywhere.
std::optional<ImageTexels> decode_tga_alpha(const std::string& path, std::span<const uint8_t> bytes);
ImageTexels decode_bmp(const std::string& path, std::span<const uint8_t> bytes);
/// Of the header's mask; the unused byte of texels of 32 bits without masks is alpha unless it is 0 everywhere.
std::optional<ImageTexels> decode_bmp_alpha(const std::string& path, std::span<const uint8_t> bytes);
ImageTexels decode_qoi(const std::string& path, std::span<const uint8_t> bytes);
std::optional<ImageTexels> decode_qoi_alpha(const std::string& path, std::span<const uint8_t> bytes);
ImageTexels decode_hdr(const std::string& path, std::span<const uint8_t> bytes);
ImageTexels decode_pfm(const std::string& path, std::span<const uint8_t> bytes);

/// All channels of the first part that has colours (else a luminance, else any one channel, else of the first part),
/// whatever their type. The picture is the data window.
Image read_exr(const InputPath& path);

/// The channels that make up the colour of an image: red, green, blue, or one of grey thrice; and its alpha, or -1.
struct ColourChannels {
  int rgb[3] = {-1, -1, -1};
  int alpha = -1;
  std::string fault;  ///< where there are none: what the image has instead, to follow "the image"

  explicit operator bool() const { return rgb[0] >= 0; }
};

/// The only channel; or those of the base layer, R, G, B before Y; or those of the only layer that has colours
/// ("NAME.R"), where there are several of the one called Combined, beauty, rgba or rgb; or the same of layers with Y.
ColourChannels colour_channels(const Image& image);

/// Whether every value of `texels` is 1.
bool is_opaque(const ImageTexels& texels);
/// `alpha`, or nothing where it is 1 everywhere.
std::optional<ImageTexels> unless_opaque(ImageTexels&& alpha);

/// The colours of an EXR image. Throws InputError where it has none. `is_data`: numbers that are no colours, which are
/// left as they stand; else they are turned to linear sRGB where the file has other primaries.
ImageTexels exr_texels(const Image& image, const std::string& path, bool is_data);
/// The colours of an image of any other format.
ImageTexels decode_texture(const std::string& path, PictureFormat format, std::span<const uint8_t> bytes,
                           TextureEncoding encoding);

}  // namespace alhazen

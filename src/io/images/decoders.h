#pragma once

// The decoders of single formats, from the bytes of a file to texels. Every one throws InputError on what it cannot
// decode whole; `path` is for messages and the name of the texels. `srgb` of the result is true for bytes.

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "io/files/input_file.h"
#include "io/images/image.h"
#include "scene/scene.h"

namespace alhazen {

enum class PictureFormat { exr, png, jpeg, tga, bmp, hdr, pfm };

/// By the first bytes of the file, whatever its name; TGA, which has no signature, by the extension of `path`.
/// Throws InputError where the file is missing or of none of these.
PictureFormat picture_format(const InputPath& path);

/// `decode_16_bit`: whether values of 16 bits are sRGB-encoded and to be decoded, or linear already.
ImageTexels decode_png(const std::string& path, std::span<const uint8_t> bytes, bool decode_16_bit);
ImageTexels decode_jpeg(const std::string& path, std::span<const uint8_t> bytes);
/// Where the program was built with libwebp; else an error that says so.
ImageTexels decode_webp(const std::string& path, std::span<const uint8_t> bytes);
/// The alpha of such a picture, in all three channels; nothing where it has none.
std::optional<ImageTexels> decode_webp_alpha(const std::string& path, std::span<const uint8_t> bytes);
ImageTexels decode_tga(const std::string& path, std::span<const uint8_t> bytes);
ImageTexels decode_bmp(const std::string& path, std::span<const uint8_t> bytes);
ImageTexels decode_hdr(const std::string& path, std::span<const uint8_t> bytes);
ImageTexels decode_pfm(const std::string& path, std::span<const uint8_t> bytes);

/// All channels of the first part, whatever their type. The picture is the data window.
Image read_exr(const InputPath& path);

/// The channels that make up the colour: R, G, B, or one channel thrice (the only one, or Y).
/// False where there are none of these.
bool colour_channels(const Image& image, int (&rgb)[3]);

}  // namespace alhazen

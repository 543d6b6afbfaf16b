#pragma once

// Writes images to files.

#include <cstdint>
#include <string>
#include <vector>

#include "alhazen/alhazen.h"
#include "alhazen/version.h"

namespace ALHAZEN_NAMESPACE {

/// How values above 1 come within what a display shows.
enum class ToneMapping { none, reinhard, filmic, aces, agx };

/// Each format uses what it names.
struct SaveOptions {
  /// PNG, JPEG: stops; values are multiplied by 2^exposure before anything else.
  double exposure = 0;
  double white_temperature = 0;  ///< PNG, JPEG: kelvin; light of this colour becomes white; 0: D65, unchanged
  ToneMapping tone_mapping = ToneMapping::none;  ///< PNG, JPEG
  int png_depth = 8;                             ///< PNG: 8 or 16 bits per channel
  int jpeg_quality = 95;                         ///< JPEG: 1 to 100
  bool single_precision = false;                 ///< EXR: of colours, too; depth, positions, ids and counts always are
};

/// Writes the image completely or not at all, replacing a file of that name. The extension chooses the format: .exr
/// (all channels, and where the pixels are within the whole image), .png, .jpg (sRGB, clamped to [0, 1]; PNG with A
/// where the image has it), .hdr, .pfm (R, G and B). Headers have the image's metadata, as those of
/// the program have (EXR, PNG, JPEG). Throws InputError for another extension, options out of range and an image
/// without pixels, OutOfMemoryError, and Error if it cannot be written. Any number of threads may save at once, to
/// different files.
void save(const RenderedImage& image, const std::string& file, const SaveOptions& options = {});

/// The bytes of the file that `save` writes under a name that ends in .png. Throws what `save` throws, and Error for an
/// image without R, G and B.
std::vector<uint8_t> encode_png(const RenderedImage& image, const SaveOptions& options = {});

}  // namespace ALHAZEN_NAMESPACE

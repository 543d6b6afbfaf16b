#pragma once

// Image files: EXR with named float channels and metadata, and other formats, read and written.

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "colour/rgb_space.h"
#include "files/input_file.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

/// An image in memory: one plane of float per channel, rows from the top down.
struct Image {
  int width = 0, height = 0;
  std::vector<std::string> channels;       ///< "R", "G", "B", "albedo.R", "depth.Z", ...
  std::vector<std::vector<float>> planes;  ///< one per channel, width * height each
  /// Of R, G and B, if the file gives them; otherwise those of sRGB.
  std::optional<Chromaticities> chromaticities = std::nullopt;

  /// Index of a channel, or -1.
  int channel(const std::string& name) const;
};

/// A source of image rows for writers, so that the image need not be in memory as a whole: `fill_row(y, row)` writes
/// the values of row `y` (0 at the top), all of channel 0 first, then all of channel 1, ...: `row` holds
/// channels.size() * width floats. fill_row may be called more than once for a row and in any order.
struct ImageSource {
  int width = 0, height = 0;
  std::vector<std::string> channels;
  std::function<void(int y, std::span<float> row)> fill_row;
};

ImageSource source_of(const Image& image);

/// Copies all rows into memory.
Image image_of(const ImageSource& source, const std::function<bool(const std::string&)>& keeps = {});

enum class ExrPixelType { half, single };
/// DWAA and DWAB lose a little, but not of layers other than colours that are parts of their own; the others lose
/// nothing.
enum class ExrCompression { none, rle, zips, zip, piz, dwaa, dwab };
enum class ToneMap { none, reinhard, filmic, aces, agx };

/// How an image is written. Each format uses the members that it names.
struct WriteOptions {
  ExrPixelType pixel_type = ExrPixelType::half;  ///< EXR
  /// EXR: prefixes of channels that are always single precision, since half floats cannot hold depth or sample counts.
  std::vector<std::string> always_single{"depth",    "distance", "position", "uv",      "motion",  "object",
                                         "material", "Crypto",   "bounces",  "samples", "variance"};
  ExrCompression compression = ExrCompression::zip;  ///< EXR
  bool has_parts = false;                            ///< EXR: a part for each layer instead of one for all
  int tile_size = 0;                                 ///< EXR: pixels along each side of a tile; 0: scanlines
  /// EXR, PNG, JPEG, HDR: text about the image, by name.
  std::map<std::string, std::string> metadata = {};
  /// EXR: the position of the image in the full frame, as origin of the data window and size of the display window.
  int x_offset = 0, y_offset = 0;
  int full_width = 0, full_height = 0;  ///< EXR; 0: those of the image
  // PNG and JPEG, in the order in which they are applied (images/display/display_transform.h):
  double exposure = 0;               ///< in stops: values are first multiplied by 2^exposure
  double white_temperature = 0;      ///< kelvin: light of this colour becomes white; 0: that of D65, which is unchanged
  ToneMap tone_map = ToneMap::none;  ///< of the linear values
  int png_depth = 8;                 ///< PNG: bits per channel, 8 or 16
  int jpeg_quality = 95;             ///< JPEG: 1 to 100, on the scale of libjpeg
};

/// Lists every format that images are written in, by its extension. write_NAME, in a file of codecs/, writes it; what
/// chooses a format, and the names in messages and help, expand from this list.
///   exr  all channels
///   png  channels R, G, B, in 8 or 16 bits; values are tone mapped, clamped to [0, 1] and sRGB-encoded, NaN is black
///   jpg  the same in 8 bits, compressed with a loss; .jpeg is another name of it
///   hdr  channels R, G, B in 8 bits each with a common exponent; negative values and NaN become 0
///   pfm  channels R, G, B as they are, in single precision
#define ALHAZEN_WRITTEN_FORMATS(FORMAT) FORMAT(exr) FORMAT(png) FORMAT(jpg) FORMAT(hdr) FORMAT(pfm)

/// Each writes the image completely or not at all, through an AtomicFile (files/atomic_file.h).
/// Throws RenderError with path and cause if that fails; existing files then remain unchanged.
#define ALHAZEN_DECLARE_WRITER(name) \
  void write_##name(const std::string& path, const ImageSource& source, const WriteOptions& options);
ALHAZEN_WRITTEN_FORMATS(ALHAZEN_DECLARE_WRITER)
#undef ALHAZEN_DECLARE_WRITER

/// Writes by the extension of `path`, which must be that of a format. Throws as the writer does.
void write_image(const std::string& path, const ImageSource& source, const WriteOptions& options);

/// Returns whether images can be written to a file of this name.
bool has_written_extension(const std::string& path);

/// The extensions for messages: ".exr, .png, .jpg, .hdr or .pfm".
std::string written_extensions();

/// Returns whether a file of this name holds what a display shows, not radiance: exposed, balanced and tone mapped.
bool is_displayed_format(const std::string& path);

/// The most pixels that a side of a JPEG may have.
inline constexpr int max_jpeg_side = 65500;

/// The positions of R, G and B among the channels, for formats that hold these alone. Throws RenderError that names
/// `path` if one is missing or the image has no pixels.
std::array<size_t, 3> rgb_channels(const std::string& path, const ImageSource& source);

/// Reads EXR (all channels of its parts that have the size of its image, unchanged) and the formats of read_texture (as
/// R, G, B; files of up to 16 bits are decoded to linear). Throws InputError.
Image read_image(const InputPath& path);

/// The extension of a path in lower case, without the dot.
std::string extension_of(const std::string& path);

/// The sRGB transfer curve (IEC 61966-2-1), for values in [0, 1].
double srgb_encode(double linear);
double srgb_decode(double encoded);

}  // namespace alhazen::impl

#pragma once

// Pictures on disk: EXR with named float channels and metadata, PNG with 8 bits, read and written.

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

namespace alhazen {

/// A picture in memory: planes of float, one a channel, rows from the top down.
struct Image {
  int width = 0, height = 0;
  std::vector<std::string> channels;       ///< "R", "G", "B", "albedo.R", "depth.Z", ...
  std::vector<std::vector<float>> planes;  ///< one a channel, width * height each
  /// Of R, G and B, where the file names them; else those of sRGB are meant.
  std::optional<Chromaticities> chromaticities = std::nullopt;

  /// Index of a channel, or -1.
  int channel(const std::string& name) const;
};

/// What a writer needs of a picture without holding it whole: `fill_row(y, row)` writes the values of row `y` (0 at the
/// top), all of channel 0 first, then all of channel 1, ... : `row` holds channels.size() * width floats.
/// fill_row may be called more than once for a row and in any order.
struct ImageSource {
  int width = 0, height = 0;
  std::vector<std::string> channels;
  std::function<void(int y, std::span<float> row)> fill_row;
};

ImageSource source_of(const Image& image);

enum class ExrPixelType { half, single };

struct ExrOptions {
  ExrPixelType pixel_type = ExrPixelType::half;
  /// Depth, sample counts and other channels that half floats cannot hold are always single; these are their prefixes.
  std::vector<std::string> always_single{"depth", "bounces", "samples", "variance"};
  /// Text attributes of the header, by name.
  std::map<std::string, std::string> metadata;
  /// Where the picture lies in the whole frame: origin of the data window and size of the display window.
  int x_offset = 0, y_offset = 0;
  int full_width = 0, full_height = 0;  ///< 0: as the picture
};

enum class ToneMap { none, reinhard, filmic };

struct PngOptions {
  double exposure = 0;  ///< stops: values are multiplied by 2^exposure first
  ToneMap tone_map = ToneMap::none;
};

/// Write the picture whole or not at all: to a temporary file beside the target, then renamed onto it.
/// Throws RenderError with path and cause where that fails; nothing that existed is touched then.
void write_exr(const std::string& path, const ImageSource& source, const ExrOptions& options);
/// Takes channels R, G, B; values are tone mapped, clamped to [0, 1] and sRGB-encoded. NaN becomes black.
void write_png(const std::string& path, const ImageSource& source, const PngOptions& options);

/// Reads EXR (all channels of its picture part, as they stand) and what read_texture reads (as R, G, B; files of up to
/// 16 bits are decoded to linear). Throws InputError.
Image read_image(const InputPath& path);

/// The extension of a path in lower case, without the dot.
std::string extension_of(const std::string& path);

/// The sRGB transfer curve (IEC 61966-2-1), for values in [0, 1].
double srgb_encode(double linear);
double srgb_decode(double encoded);

}  // namespace alhazen

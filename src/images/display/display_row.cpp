#include "images/display/display_row.h"

#include <cmath>

#include "images/display/tone_map.h"

namespace alhazen {

namespace {

uint8_t encode(double linear) { return static_cast<uint8_t>(std::floor(255 * srgb_encode(linear) + 0.5)); }

}  // namespace

void encode_display_row(std::span<const float> row, const std::array<size_t, 3>& channels, const WriteOptions& options,
                        std::span<uint8_t> encoded) {
  const size_t width = encoded.size() / 3;
  const double factor = std::exp2(options.exposure);
  for (size_t x = 0; x < width; ++x) {
    Vec3d colour;
    for (int c = 0; c < 3; ++c)
      colour[c] = factor * static_cast<double>(row[channels[static_cast<size_t>(c)] * width + x]);
    colour = tone_map(colour, options.tone_map);
    for (int c = 0; c < 3; ++c) encoded[3 * x + static_cast<size_t>(c)] = encode(colour[c]);
  }
}

std::vector<uint8_t> display_bytes(const std::string& name, const ImageSource& source, const WriteOptions& options) {
  const std::array<size_t, 3> channels = rgb_channels(name, source);
  const size_t width = static_cast<size_t>(source.width);
  std::vector<float> row(source.channels.size() * width);
  std::vector<uint8_t> bytes(3 * width * static_cast<size_t>(source.height));
  for (int y = 0; y < source.height; ++y) {
    source.fill_row(y, row);
    encode_display_row(row, channels, options, std::span(bytes).subspan(3 * width * static_cast<size_t>(y), 3 * width));
  }
  return bytes;
}

}  // namespace alhazen

#include "images/display/display_bytes.h"

#include <algorithm>

#include "images/display/display_transform.h"

namespace alhazen::impl {

std::vector<uint8_t> display_bytes(const std::string& name, const ImageSource& source, const WriteOptions& options) {
  const std::array<size_t, 3> channels = rgb_channels(name, source);
  const DisplayTransform display(options);
  const size_t width = static_cast<size_t>(source.width);
  std::vector<float> row(source.channels.size() * width);
  std::vector<uint16_t> encoded(3 * width);
  std::vector<uint8_t> bytes;
  bytes.reserve(3 * width * static_cast<size_t>(source.height));
  for (int y = 0; y < source.height; ++y) {
    source.fill_row(y, row);
    display.encode_row(row, channels, 255, encoded);
    for (const uint16_t value : encoded) bytes.push_back(static_cast<uint8_t>(value));
  }
  return bytes;
}

}  // namespace alhazen::impl

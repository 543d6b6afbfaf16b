#pragma once

// Rows of an image as 8-bit formats show them.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "images/image.h"

namespace alhazen {

/// Encodes a row as an ImageSource fills it: three bytes of sRGB per pixel, by the exposure and the tone map of
/// `options`. `channels` are the positions of R, G and B; `encoded` has the size of the result.
void encode_display_row(std::span<const float> row, const std::array<size_t, 3>& channels, const WriteOptions& options,
                        std::span<uint8_t> encoded);

/// All rows of an image, as a PNG file has them. `name` is for messages.
std::vector<uint8_t> display_bytes(const std::string& name, const ImageSource& source, const WriteOptions& options);

}  // namespace alhazen

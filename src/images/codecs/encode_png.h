#pragma once

#include <cstdint>
#include <vector>

#include "images/image.h"

namespace alhazen::impl {

/// The bytes of an 8-bit PNG of the colours, clamped to [0, 1] and sRGB-encoded; NaN is black. A single channel is
/// grey. Throws InputError if the image has no colours.
std::vector<uint8_t> encode_png(const Image& image);

}  // namespace alhazen::impl

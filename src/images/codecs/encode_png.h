#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "images/image.h"

namespace alhazen::impl {

/// The bytes of an 8-bit PNG of the colours, clamped to [0, 1] and sRGB-encoded; NaN is black. A single channel is
/// grey. Throws InputError if the image has no colours.
std::vector<uint8_t> encode_png(const Image& image);

/// Takes the next bytes of a file.
using PngSink = std::function<void(const uint8_t* data, size_t size)>;

/// Hands on the bytes of what write_png writes with these options. `name` is for messages. Throws RenderError, and what
/// `sink` throws.
void encode_png(const std::string& name, const ImageSource& source, const WriteOptions& options, const PngSink& sink);

}  // namespace alhazen::impl

#pragma once

// A whole image as displays show it.

#include <cstdint>
#include <string>
#include <vector>

#include "images/image.h"

namespace alhazen::impl {

/// Three bytes of sRGB per pixel, rows from the top down: what an opaque PNG file has. `name` is for messages.
std::vector<uint8_t> display_bytes(const std::string& name, const ImageSource& source, const WriteOptions& options);

}  // namespace alhazen::impl

#pragma once

// Reads images from files.

#include <string>

#include "alhazen/alhazen.h"
#include "alhazen/version.h"

namespace ALHAZEN_NAMESPACE {

/// Reads EXR (all channels of its parts that have the size of its image, unchanged), PNG, JPEG, TGA, BMP, QOI, HDR, PFM
/// or WebP (R, G and B; formats for displays are decoded to linear). Throws InputError, OutOfMemoryError.
RenderedImage read_image(const std::string& file);

}  // namespace ALHAZEN_NAMESPACE

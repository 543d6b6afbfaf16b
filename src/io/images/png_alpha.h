#pragma once

// The alpha channel of PNG files, which decode_png leaves out.

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "scene/scene.h"

namespace alhazen {

/// The alpha channel as a linear grey picture of 8 bits; nothing where the file has no transparency, neither a channel
/// nor a transparent colour. Throws InputError as decode_png does.
std::optional<ImageTexels> decode_png_alpha(const std::string& path, std::span<const uint8_t> bytes);

}  // namespace alhazen

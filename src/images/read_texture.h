#pragma once

// Reads images as textures: PNG, JPEG, TGA, BMP, QOI, WebP, HDR, PFM and EXR.

#include <string>

#include "files/input_file.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// `data`: linear values that are not colours, such as normals; primaries in EXR files are ignored.
enum class TextureEncoding { automatic, srgb, linear, data };

/// Reads an image for use as a texture. 8-bit files stay 8-bit and are marked sRGB unless `encoding` is linear; 16-bit
/// and float files become floats, decoded from sRGB if the format is so encoded (16-bit PNG). Grey becomes three equal
/// channels; alpha is ignored (read_scalar_texture reads it); colours of EXR files with other primaries than sRGB are
/// converted to linear sRGB. Throws InputError that names the file and the problem: missing, unreadable, of an unknown
/// format, over 2^30 texels.
ImageTexels read_texture(const InputPath& path, TextureEncoding encoding);

}  // namespace alhazen::impl

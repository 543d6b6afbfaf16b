#pragma once

// Pictures as textures: PNG, JPEG, TGA, BMP, QOI, WebP, HDR, PFM and EXR, to texels.

#include <string>

#include "files/input_file.h"
#include "scene/scene.h"

namespace alhazen {

/// `data`: linear, and no colours, as normals are: whatever primaries an EXR file has, its numbers are taken as they
/// are.
enum class TextureEncoding { automatic, srgb, linear, data };

/// Reads a picture for use as a texture. 8-bit files stay 8-bit and are marked sRGB unless `encoding` is linear; 16-bit
/// and float files become floats, decoded from sRGB where the format says so (16-bit PNG). Grey becomes three equal
/// channels; alpha is left out; colours of EXR files whose primaries are not those of sRGB are turned to linear sRGB
/// (read_scalar_texture reads it). Throws InputError that names the file and what is wrong: missing, unreadable, of an
/// unknown kind, over 2^30 texels.
ImageTexels read_texture(const InputPath& path, TextureEncoding encoding);

}  // namespace alhazen

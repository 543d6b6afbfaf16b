#pragma once

// Images as scalar textures: one channel, from the alpha of the file or from its colours.

#include <string>

#include "images/read_texture.h"

namespace alhazen {

struct ScalarTexture {
  ImageTexels texels;  ///< of one channel, unless the image is grey and keeps its encoded bytes in three equal ones
  bool from_alpha = false;
  /// True where the values are those of an alpha channel that pbrt-v4 does not read: it knows alpha in EXR and QOI
  /// files and in PNG files of the colour type RGBA, and averages the colours of all others.
  bool differs_from_pbrt = false;
};

/// Reads an image for use as a scalar: its alpha channel where it has one that is not 1 everywhere, else the mean of
/// its linear colours. Alpha is linear whatever `encoding` says, since every format defines it so. Throws InputError.
ScalarTexture read_scalar_texture(const InputPath& path, TextureEncoding encoding);

}  // namespace alhazen

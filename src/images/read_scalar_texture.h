#pragma once

// Images as scalar textures: one channel, from the file's alpha or from its colours.

#include <string>

#include "images/read_texture.h"

namespace alhazen::impl {

struct ScalarTexture {
  ImageTexels texels;  ///< one channel, unless the image is grey and keeps its encoded bytes in three equal channels
  bool from_alpha = false;
  /// True if the values come from an alpha channel that pbrt-v4 does not read: it reads alpha of EXR and QOI files and
  /// of PNG files of the colour type RGBA, and averages the colours of all others.
  bool differs_from_pbrt = false;
};

/// Reads an image for use as a scalar: its alpha channel if there is one that is not 1 everywhere, else the mean of its
/// linear colours. Alpha is linear whatever `encoding` says, as every format defines it. Throws InputError.
ScalarTexture read_scalar_texture(const InputPath& path, TextureEncoding encoding);

}  // namespace alhazen::impl

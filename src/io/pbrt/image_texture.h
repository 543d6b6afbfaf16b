#pragma once

// Pictures of scene files as textures.

#include "io/pbrt/build.h"

namespace alhazen::pbrt {

/// Reads the parameters of an `imagemap`, and the picture where this file was not read that way before.
void read_image_texture(Build& build, ParameterList& list, bool is_float, Texture& texture);

}  // namespace alhazen::pbrt

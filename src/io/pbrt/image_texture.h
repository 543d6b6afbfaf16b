#pragma once

// Image files as textures.

#include "io/pbrt/build.h"

namespace alhazen::impl::pbrt {

/// Reads the parameters of an `imagemap`, and the image unless the file has been read with the same parameters.
void read_image_texture(Build& build, ParameterList& list, bool is_float, Texture& texture);

}  // namespace alhazen::impl::pbrt

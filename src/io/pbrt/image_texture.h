#pragma once

// Pictures of scene files: as textures and as the mean colour of a sky.

#include "io/pbrt/build.h"

namespace alhazen::pbrt {

/// Reads the parameters of an `imagemap`, and the picture where this file was not read that way before.
void read_image_texture(Build& build, ParameterList& list, bool is_float, Texture& texture);

/// Mean linear colour of a picture of the whole sphere: equal-area where it is square as pbrt-v4 has it, else weighted
/// as latitude and longitude.
Vec3d mean_of_sphere(const ImageTexels& image);

}  // namespace alhazen::pbrt

#pragma once

// Images in memory of the public interface in the description, and back.

#include "alhazen/arrays.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// A copy as an image of textures. Throws alhazen::InputError that names the member.
ImageTexels image_of_pixels(const Pixels& pixels);

/// A copy as a map of an infinite light or the image of another: three linear floats per texel, none of them negative.
ImageTexels light_map_of_pixels(const Pixels& pixels);

/// A view.
Pixels pixels_of(const ImageTexels& image);

}  // namespace alhazen::impl

#pragma once

// Parts of images that are compared by themselves: layers and regions.

#include <array>
#include <string>
#include <vector>

#include "images/image.h"

namespace alhazen::impl {

/// The names of the layers of an image, in the order of its channels: "albedo" for albedo.R, albedo.G and albedo.B. The
/// image itself, R G B, is "".
std::vector<std::string> layer_names(const Image& image);

/// The channels of a layer as an image: as R, G and B if there are three (R G B, or X Y Z), else as the only channel.
/// Throws InputError that lists the layers if there is none of that name; `file` is named in it.
Image layer_of(const Image& image, const std::string& layer, const std::string& file);

/// The pixels from (x0, y0) to before (x1, y1). Throws InputError if they are not all in the image, or none.
Image region_of(const Image& image, const std::array<int64_t, 4>& bounds);

}  // namespace alhazen::impl

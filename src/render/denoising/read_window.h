#pragma once

// Reads windows from a tile.

#include "render/denoising/tile.h"
#include "render/denoising/window.h"

namespace alhazen::impl::denoising {

/// Writes the window around (x, y) of a plane.
void read_window(const TilePlane& plane, int x, int y, WindowRow& to);

/// Reads the inputs at (x, y), and by how much the features of each pixel differ from those of the centre, beyond
/// noise.
void read_inputs(const Tile& tile, int x, int y, WindowInputs& inputs, WindowRow& feature_distances);

}  // namespace alhazen::impl::denoising

#pragma once

// An image as text for a terminal with colours of 24 bits: a character for every two pixels, one above the other.

#include <string>
#include <vector>

#include "images/display/display_transform.h"
#include "images/image.h"

namespace alhazen::impl {

/// Linear colours, three floats per pixel, rows from the top down.
struct ReducedImage {
  int width = 0, height = 0;
  std::vector<float> rgb;
};

/// R, G and B made small enough for both limits, with the same shape: each pixel is the mean of the area that it
/// covers. Never made larger. Values that are infinite or NaN count as black.
ReducedImage reduce_image(const ImageSource& source, int max_width, int max_height);

/// The same of what is reduced already.
ReducedImage reduce_image(const ReducedImage& image, int max_width, int max_height);

/// Lines without their ends; each begins and ends with the colours of the terminal. With `half_blocks` a character is
/// the upper half of a block (U+2580) in UTF-8, in the colour of the upper pixel over that of the lower one; without,
/// it is a blank in the mean of both.
std::vector<std::string> terminal_lines(const ReducedImage& image, const DisplayTransform& display, bool half_blocks);

}  // namespace alhazen::impl

#pragma once

// The page of `alhazen compare --html`.

#include <string>
#include <vector>

#include "images/image.h"
#include "images/metrics/compare.h"

namespace alhazen::impl {

/// One comparison: of a layer, or of the colours.
struct ComparedPart {
  std::string layer;  ///< empty: the colours
  Image a, b, heat_map;
  ImageDifference difference;
};

/// One HTML file with the images in it. It shows each pair one over the other with a slider between them, alternating,
/// side by side, and as the map of the error; also on a screen 390 pixels wide.
std::string comparison_page(const std::string& a, const std::string& b, const std::vector<ComparedPart>& parts);

}  // namespace alhazen::impl

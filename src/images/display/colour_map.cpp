#include "images/display/colour_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "images/image.h"

namespace alhazen::impl {

namespace {

/// Equidistant samples of the colour map "magma" (Smith and van der Walt 2015, in the public domain), sRGB-encoded with
/// 8 bits.
constexpr std::array<Vec3d, 9> knots{{{0, 0, 4},
                                      {28, 16, 68},
                                      {79, 18, 123},
                                      {129, 37, 129},
                                      {181, 54, 122},
                                      {229, 80, 100},
                                      {251, 135, 97},
                                      {254, 194, 135},
                                      {252, 253, 191}}};

}  // namespace

Vec3d error_colour(double value) {
  const double place = std::clamp(value, 0.0, 1.0) * (knots.size() - 1);
  const size_t knot = std::min(static_cast<size_t>(place), knots.size() - 2);
  const Vec3d encoded = lerp(knots[knot], knots[knot + 1], place - static_cast<double>(knot)) / 255.0;
  return {srgb_decode(encoded.x), srgb_decode(encoded.y), srgb_decode(encoded.z)};
}

}  // namespace alhazen::impl

#include <cmath>

#include "images/image.h"

namespace alhazen::impl {

// The constants are those of IEC 61966-2-1, whose two thresholds agree to within 1e-7.

double srgb_encode(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

double srgb_decode(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

}  // namespace alhazen::impl

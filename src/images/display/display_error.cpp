#include "images/display/display_error.h"

#include <algorithm>

#include "images/display/tone_map.h"

namespace alhazen {

double DisplayCurve::operator()(double luminance) const {
  return srgb_encode(alhazen::tone_map(splat(luminance * scale), tone_map).x);
}

double DisplayCurve::error(double luminance, double deviation) const {
  return ((*this)(luminance + deviation) - (*this)(std::max(0.0, luminance - deviation))) / 2;
}

}  // namespace alhazen

#pragma once

// The exposure of images whose lights have no definite brightness.

#include <vector>

namespace alhazen {

/// The largest channels of an image's pixels, those above 0, in any order: the exposure, in whole stops, by which their
/// median is at most about 0.85 if it is above 3, else 0.
double fitting_exposure(std::vector<float> brightness);

}  // namespace alhazen

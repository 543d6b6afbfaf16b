#include "images/display/fitting_exposure.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace alhazen {

double fitting_exposure(std::vector<float> brightness) {
  if (brightness.empty()) return 0;
  const auto middle = brightness.begin() + static_cast<std::ptrdiff_t>(brightness.size() / 2);
  std::nth_element(brightness.begin(), middle, brightness.end());
  const double median = static_cast<double>(*middle);
  // log2(median / 0.6), rounded; std::log2 may differ from machine to machine.
  return median > 3 ? -std::ilogb(median / 0.6 * std::sqrt(2.0)) : 0;
}

}  // namespace alhazen

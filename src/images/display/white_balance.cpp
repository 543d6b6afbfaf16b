#include "images/display/white_balance.h"

#include <algorithm>
#include <cmath>

#include "colour/rgb_space.h"
#include "colour/white_point.h"

namespace alhazen::impl {

WhiteBalance::WhiteBalance(double kelvin)
    : rows_(kelvin > 0 ? srgb_adaptation(white_point(kelvin), white_point(d65_temperature))
                       : std::array<Vec3d, 3>{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}) {}

void LightColourEstimate::add(const Vec3d& radiance, double weight) {
  const double brightest_channel = max_component(radiance);
  if (!is_finite(radiance) || !(brightest_channel > 0) || !(weight > 0)) return;
  const Vec3d relative = max(radiance, splat(0.0)) / std::max(brightest_channel, brightest_);
  const Vec3d cube = relative * relative * relative;
  sums_ += weight * (cube * cube);
}

double LightColourEstimate::temperature() const {
  const Vec3d light{std::pow(sums_.x, 1.0 / 6), std::pow(sums_.y, 1.0 / 6), std::pow(sums_.z, 1.0 / 6)};
  const Vec3d xyz = srgb_to_xyz(light);
  const double sum = xyz.x + xyz.y + xyz.z;
  if (!(sum > 0)) return d65_temperature;
  const double kelvin = std::clamp(nearest_white_temperature({xyz.x / sum, xyz.y / sum}), warmest, coldest);
  return 50 * std::round(kelvin / 50);
}

}  // namespace alhazen::impl

#include "colour/white_point.h"

#include <algorithm>
#include <cmath>

#include "colour/cie_1931.h"
#include "colour/spectrum.h"

namespace alhazen::impl {

namespace {

Vec2d black_body(double kelvin) {
  const Spectrum spectrum = blackbody_spectrum(kelvin);
  Vec3d xyz;
  for (int nanometres = first_visible; nanometres <= last_visible; ++nanometres)
    xyz += cie_1931(nanometres) * spectrum.at(nanometres);
  const double sum = xyz.x + xyz.y + xyz.z;
  return {xyz.x / sum, xyz.y / sum};
}

/// CIE 15:2018, equations 4.9 to 4.11.
Vec2d daylight(double kelvin) {
  const double t = 1000 / kelvin;
  const double x = kelvin <= 7000 ? ((-4.6070 * t + 2.9678) * t + 0.09911) * t + 0.244063
                                  : ((-2.0064 * t + 1.9018) * t + 0.24748) * t + 0.237040;
  return {x, (-3.000 * x + 2.870) * x - 0.275};
}

Vec2d uniform(const Vec2d& xy) {
  const double divisor = -2 * xy.x + 12 * xy.y + 3;
  return {4 * xy.x / divisor, 6 * xy.y / divisor};
}

double squared_distance(const Vec2d& a, const Vec2d& b) {
  const double x = a.x - b.x, y = a.y - b.y;
  return x * x + y * y;
}

}  // namespace

Vec2d white_point(double kelvin) {
  constexpr double last_black_body = 4000, first_daylight = 5000;
  const double part = std::clamp((kelvin - last_black_body) / (first_daylight - last_black_body), 0.0, 1.0);
  if (part == 0) return black_body(kelvin);
  const Vec2d day = daylight(kelvin);
  if (part == 1) return day;
  const Vec2d black = black_body(kelvin);
  return {black.x + part * (day.x - black.x), black.y + part * (day.y - black.y)};
}

double nearest_white_temperature(const Vec2d& xy) {
  const Vec2d wanted = uniform(xy);
  // Reciprocal temperatures are about as far apart as colours look.
  constexpr double step = 2e-6;
  double nearest = d65_temperature, distance = 1e300;
  for (double reciprocal = 1 / max_white_temperature; reciprocal <= 1 / min_white_temperature; reciprocal += step) {
    const double found = squared_distance(uniform(white_point(1 / reciprocal)), wanted);
    if (found < distance) {
      distance = found;
      nearest = 1 / reciprocal;
    }
  }
  return nearest;
}

}  // namespace alhazen::impl

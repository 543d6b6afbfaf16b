// AgX (Sobotka 2022, the configuration "AgX-S2O3" for OpenColorIO): a sigmoid over the logarithm, in primaries that lie
// within those of sRGB, so that bright saturated colours turn to white without a change of hue at a corner of the
// gamut.

#include <algorithm>
#include <array>
#include <cmath>

#include "images/display/display_error.h"
#include "images/display/tone_map.h"

namespace alhazen::impl {

namespace {

/// Stops below and above middle grey that are told apart.
constexpr double darkest_stop = -10, brightest_stop = 6.5, agx_grey = 0.18;

/// Where middle grey is on the logarithmic scale from 0 to 1, and what the sigmoid makes of it.
constexpr double pivot = -darkest_stop / (brightest_stop - darkest_stop), value_at_pivot = 0.5;

/// The slope of the sigmoid at the pivot, and the powers that bend its toe and its shoulder ("default contrast").
constexpr double slope = 2, toe_power = 3, shoulder_power = 3.25;

double power(double base, double exponent) { return portable_exp2(exponent * portable_log2(base)); }

/// One half of the sigmoid, measured from the pivot: y = s x / (1 + (s x / c)^p)^(1 / p). The scale c makes it pass
/// through (`x_end`, `y_end`).
double half_sigmoid(double x, double x_end, double y_end, double p) {
  if (x <= 0) return 0;
  const double linear = slope * x_end;
  const double scale = power(power(linear, -p) * (power(linear / y_end, p) - 1), -1 / p);
  return slope * x / power(1 + power(slope * x / scale, p), 1 / p);
}

double sigmoid(double x) {
  if (x < pivot) return value_at_pivot - half_sigmoid(pivot - x, pivot, value_at_pivot, toe_power);
  return value_at_pivot + half_sigmoid(x - pivot, 1 - pivot, 1 - value_at_pivot, shoulder_power);
}

/// A function over [0, 1], interpolated linearly.
class Table {
 public:
  template <class Function>
  explicit Table(const Function& function) {
    for (size_t i = 0; i <= intervals; ++i) values_[i] = function(static_cast<double>(i) / intervals);
  }

  double operator()(double x) const {
    const double place = std::clamp(x, 0.0, 1.0) * intervals;
    const size_t i = std::min(static_cast<size_t>(place), intervals - 1);
    return values_[i] + (values_[i + 1] - values_[i]) * (place - static_cast<double>(i));
  }

 private:
  /// As many as the published table of the sigmoid has values; the error is below a step of 16 bits.
  static constexpr size_t intervals = 4096;
  std::array<double, intervals + 1> values_;
};

/// The sigmoid of a linear value.
double encode(double linear) {
  static const Table table([](double x) { return std::clamp(sigmoid(x), 0.0, 1.0); });
  static const double log_of_grey = portable_log2(agx_grey);
  if (!(linear > 0)) return 0;
  return table((portable_log2(linear) - log_of_grey - darkest_stop) / (brightest_stop - darkest_stop));
}

/// The light of a display with the exponent 2.2, for which the sigmoid's values are made.
double displayed(double encoded) {
  static const Table table([](double x) { return x > 0 ? power(x, 2.2) : 0; });
  return table(encoded);
}

using Rows = std::array<Vec3d, 3>;

constexpr Vec3d multiply(const Rows& rows, const Vec3d& v) {
  return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)};
}

constexpr Rows columns_of(const Rows& m) {
  return {{{m[0].x, m[1].x, m[2].x}, {m[0].y, m[1].y, m[2].y}, {m[0].z, m[1].z, m[2].z}}};
}

constexpr Rows inverse(const Rows& m) {
  const double determinant = dot(m[0], cross(m[1], m[2]));
  return columns_of(
      {{cross(m[1], m[2]) / determinant, cross(m[2], m[0]) / determinant, cross(m[0], m[1]) / determinant}});
}

/// From sRGB to primaries whose distances to white are 1.25 times as long, as the configuration derives it.
constexpr Rows inset{{{0.842479062253094, 0.0784335999999992, 0.0792237451477643},
                      {0.0423282422610123, 0.878468636469772, 0.0791661274605434},
                      {0.0423756549057051, 0.0784336, 0.879142973793104}}};
/// What viewers do after the sigmoid, so that colours of medium brightness keep their saturation.
constexpr Rows outset = inverse(inset);

}  // namespace

Vec3d agx(const Vec3d& colour) {
  const Vec3d in = multiply(inset, colour);
  const Vec3d out = multiply(outset, Vec3d{encode(in.x), encode(in.y), encode(in.z)});
  return {displayed(out.x), displayed(out.y), displayed(out.z)};
}

}  // namespace alhazen::impl

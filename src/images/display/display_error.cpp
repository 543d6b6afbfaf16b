#include "images/display/display_error.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "images/display/tone_map.h"

namespace alhazen::impl {

namespace {

/// The cube root of x from 0.03 to 1, by Newton's method from the line through two of its values.
double cube_root(double x) {
  double root = 0.4 + 0.62 * x;
  for (int i = 0; i < 6; ++i) root = (2 * root + x / (root * root)) / 3;
  return root;
}

}  // namespace

double portable_srgb_encode(double linear) {
  if (linear <= 0.0031308) return 12.92 * linear;
  const double root = std::sqrt(linear);
  return 1.055 * std::sqrt(root) * cube_root(root) - 0.055;
}

double DisplayCurve::operator()(double luminance) const {
  return portable_srgb_encode(impl::tone_map(splat(luminance * scale), tone_map).x);
}

double DisplayCurve::error(double luminance, double deviation) const {
  return ((*this)(luminance + deviation) - (*this)(std::max(0.0, luminance - deviation))) / 2;
}

double portable_log2(double value) {
  int exponent = 0;
  double mantissa = std::frexp(value, &exponent);
  if (mantissa < std::numbers::sqrt2 / 2) {
    mantissa *= 2;
    --exponent;
  }
  // ln m = 2 artanh z, whose series converges fast, since |z| is at most 0.172.
  const double z = (mantissa - 1) / (mantissa + 1);
  double sum = 0;
  for (int k = 21; k >= 1; k -= 2) sum = sum * (z * z) + 1.0 / k;
  return exponent + 2 * z * sum * std::numbers::log2e;
}

double portable_exp2(double exponent) {
  const double whole = std::floor(exponent);
  double rest = exponent - whole, root = 2, power = 1;
  while (rest > 0) {
    root = std::sqrt(root);
    rest *= 2;
    if (rest >= 1) {
      power *= root;
      rest -= 1;
    }
  }
  return std::ldexp(power, static_cast<int>(whole));
}

}  // namespace alhazen::impl

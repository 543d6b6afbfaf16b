#pragma once

// Random numbers for the tests, from a generator that is not under test and is the same on every platform.

#include <cmath>
#include <random>

#include "core/math/scalar.h"
#include "core/math/vec.h"

namespace alhazen::impl::test {

class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}

  /// Returns a number in [0, 1) with all the bits of Real.
  template <class Real>
  Real uniform() {
    if constexpr (sizeof(Real) == sizeof(float))
      return static_cast<Real>(engine_() >> 40) * static_cast<Real>(0x1p-24);
    else
      return static_cast<Real>(engine_() >> 11) * static_cast<Real>(0x1p-53);
  }

  template <class Real>
  Vec2<Real> uniform_2d() {
    const Real x = uniform<Real>();
    return {x, uniform<Real>()};
  }

  double between(double low, double high) { return low + (high - low) * uniform<double>(); }
  /// Returns a log-uniform number: every magnitude between the two is equally likely.
  double magnitude_between(double low, double high) { return std::exp(between(std::log(low), std::log(high))); }
  uint32_t below(uint32_t count) { return static_cast<uint32_t>(uniform<double>() * count); }

  Vec3d in_box(double low, double high) {
    const double x = between(low, high), y = between(low, high);
    return {x, y, between(low, high)};
  }

  Vec3d on_sphere() {
    const double z = between(-1, 1), phi = between(0, 2 * pi<double>), r = safe_sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }

  /// Returns a uniform direction on the side of `normal`.
  Vec3d on_hemisphere(const Vec3d& normal) { return face_forward(on_sphere(), normal); }

 private:
  std::mt19937_64 engine_;
};

}  // namespace alhazen::impl::test

#pragma once

// The one vector type: points, directions, normals and linear sRGB colours are all Vec3.

#include <cmath>
#include <cstddef>

#include "core/math/platform.h"

namespace ALHAZEN_CORE {

template <class Real>
struct Vec2 {
  Real x{}, y{};

  friend ALHAZEN_HD constexpr bool operator==(const Vec2&, const Vec2&) = default;
};

template <class Real>
struct Vec3 {
  Real x{}, y{}, z{};

  ALHAZEN_HD constexpr Real operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  ALHAZEN_HD constexpr Real& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }

  ALHAZEN_HD constexpr Vec3& operator+=(const Vec3& b) { return *this = *this + b; }
  ALHAZEN_HD constexpr Vec3& operator-=(const Vec3& b) { return *this = *this - b; }
  ALHAZEN_HD constexpr Vec3& operator*=(const Vec3& b) { return *this = *this * b; }
  ALHAZEN_HD constexpr Vec3& operator*=(Real s) { return *this = *this * s; }

  friend ALHAZEN_HD constexpr Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend ALHAZEN_HD constexpr Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend ALHAZEN_HD constexpr Vec3 operator*(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
  friend ALHAZEN_HD constexpr Vec3 operator/(const Vec3& a, const Vec3& b) { return {a.x / b.x, a.y / b.y, a.z / b.z}; }
  friend ALHAZEN_HD constexpr Vec3 operator*(const Vec3& a, Real s) { return {a.x * s, a.y * s, a.z * s}; }
  friend ALHAZEN_HD constexpr Vec3 operator*(Real s, const Vec3& a) { return a * s; }
  friend ALHAZEN_HD constexpr Vec3 operator/(const Vec3& a, Real s) { return {a.x / s, a.y / s, a.z / s}; }
  friend ALHAZEN_HD constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
  friend ALHAZEN_HD constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

template <class Real>
ALHAZEN_HD constexpr Vec3<Real> splat(Real value) {
  return {value, value, value};
}

/// Converts each component to another precision, rounding to nearest.
template <class To, class From>
ALHAZEN_HD constexpr Vec3<To> convert(const Vec3<From>& v) {
  return {static_cast<To>(v.x), static_cast<To>(v.y), static_cast<To>(v.z)};
}

template <class Real>
ALHAZEN_HD constexpr Real dot(const Vec3<Real>& a, const Vec3<Real>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class Real>
ALHAZEN_HD constexpr Real abs_dot(const Vec3<Real>& a, const Vec3<Real>& b) {
  const Real d = dot(a, b);
  return d < 0 ? -d : d;
}

template <class Real>
ALHAZEN_HD constexpr Vec3<Real> cross(const Vec3<Real>& a, const Vec3<Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class Real>
ALHAZEN_HD constexpr Real length_squared(const Vec3<Real>& v) {
  return dot(v, v);
}

template <class Real>
ALHAZEN_HD Real length(const Vec3<Real>& v) {
  return std::sqrt(dot(v, v));
}

/// The unit vector along `v`, which must not be zero.
template <class Real>
ALHAZEN_HD Vec3<Real> normalize(const Vec3<Real>& v) {
  return v * (Real(1) / length(v));
}

template <class Real>
ALHAZEN_HD Vec3<Real> abs(const Vec3<Real>& v) {
  return {std::abs(v.x), std::abs(v.y), std::abs(v.z)};
}

template <class Real>
ALHAZEN_HD constexpr Vec3<Real> min(const Vec3<Real>& a, const Vec3<Real>& b) {
  return {a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z};
}

template <class Real>
ALHAZEN_HD constexpr Vec3<Real> max(const Vec3<Real>& a, const Vec3<Real>& b) {
  return {a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z};
}

template <class Real>
ALHAZEN_HD constexpr Real max_component(const Vec3<Real>& v) {
  const Real xy = v.x > v.y ? v.x : v.y;
  return xy > v.z ? xy : v.z;
}

template <class Real>
ALHAZEN_HD constexpr int max_axis(const Vec3<Real>& v) {
  if (v.x > v.y) return v.x > v.z ? 0 : 2;
  return v.y > v.z ? 1 : 2;
}

template <class Real>
ALHAZEN_HD constexpr bool is_zero(const Vec3<Real>& v) {
  return v.x == 0 && v.y == 0 && v.z == 0;
}

template <class Real>
ALHAZEN_HD bool is_finite(const Vec3<Real>& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Relative luminance Y of a linear sRGB colour (IEC 61966-2-1 primaries, D65).
template <class Real>
ALHAZEN_HD constexpr Real luminance(const Vec3<Real>& rgb) {
  return Real(0.2126390058715103) * rgb.x + Real(0.7151686787677559) * rgb.y + Real(0.0721923153607337) * rgb.z;
}

template <class Real>
ALHAZEN_HD constexpr Vec3<Real> lerp(const Vec3<Real>& a, const Vec3<Real>& b, Real t) {
  return a * (Real(1) - t) + b * t;
}

template <class Real>
ALHAZEN_HD constexpr Vec3<Real> face_forward(const Vec3<Real>& v, const Vec3<Real>& reference) {
  return v * (dot(v, reference) < 0 ? Real(-1) : Real(1));
}

/// Arguments are passed by value: compilers turn a choice between references into one between addresses, for which SIMD
/// has no instruction.
template <class Real>
ALHAZEN_HD constexpr Vec3<Real> select(bool first, Vec3<Real> a, Vec3<Real> b) {
  return {first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z};
}

using Vec2f = Vec2<float>;
using Vec2d = Vec2<double>;
using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;

}  // namespace ALHAZEN_CORE

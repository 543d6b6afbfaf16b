#pragma once

// 4x4 matrices that may be singular, which Transform does not allow.

#include <algorithm>
#include <cmath>

#include "scene/transform.h"

namespace alhazen::impl::gltf {

inline constexpr Matrix4 identity{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

inline Matrix4 multiply(const Matrix4& a, const Matrix4& b) {
  Matrix4 product{};
  for (size_t i = 0; i < 4; ++i)
    for (size_t j = 0; j < 4; ++j)
      for (size_t k = 0; k < 4; ++k) product[i][j] += a[i][k] * b[k][j];
  return product;
}

inline void add_scaled(Matrix4& sum, const Matrix4& m, double weight) {
  for (size_t i = 0; i < 4; ++i)
    for (size_t j = 0; j < 4; ++j) sum[i][j] += weight * m[i][j];
}

inline Vec3d transform_direction(const Matrix4& m, const Vec3d& v) {
  const auto row = [&](size_t i) { return m[i][0] * v.x + m[i][1] * v.y + m[i][2] * v.z; };
  return {row(0), row(1), row(2)};
}

inline Vec3d transform_point(const Matrix4& m, const Vec3d& p) {
  return transform_direction(m, p) + Vec3d{m[0][3], m[1][3], m[2][3]};
}

inline Vec3d column(const Matrix4& m, size_t i) { return {m[0][i], m[1][i], m[2][i]}; }

inline double determinant(const Matrix4& m) { return dot(cross(column(m, 0), column(m, 1)), column(m, 2)); }

/// Uses the cofactors, which are the inverse transpose times the determinant; the sign is chosen so that mirroring
/// keeps the normal on its side.
inline Vec3d transform_normal(const Matrix4& m, const Vec3d& n) {
  const Vec3d x = column(m, 0), y = column(m, 1), z = column(m, 2);
  const Vec3d moved = cross(y, z) * n.x + cross(z, x) * n.y + cross(x, y) * n.z;
  return dot(cross(x, y), z) < 0 ? -moved : moved;
}

/// T R S, with the rotation a quaternion x, y, z, w of any length.
inline Matrix4 from_trs(const Vec3d& translation, std::array<double, 4> q, const Vec3d& scale) {
  const auto length_of_q = [&] { return std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]); };
  double size = length_of_q();
  if (!(size > 1e-140 && size < 1e140)) {
    // The squares overflow or underflow the range of double, or all are 0.
    const double largest = std::max({std::abs(q[0]), std::abs(q[1]), std::abs(q[2]), std::abs(q[3])});
    if (largest > 0)
      for (double& value : q) value /= largest;
    size = length_of_q();
  }
  if (size > 0)
    for (double& value : q) value /= size;
  else
    q = {0, 0, 0, 1};
  const auto [x, y, z, w] = q;
  Matrix4 m{{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), translation.x},
             {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), translation.y},
             {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), translation.z},
             {0, 0, 0, 1}}};
  for (size_t i = 0; i < 3; ++i) {
    m[i][0] *= scale.x;
    m[i][1] *= scale.y;
    m[i][2] *= scale.z;
  }
  return m;
}

}  // namespace alhazen::impl::gltf

#include "scene/transform.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace alhazen::impl {

namespace {

constexpr Matrix4 identity_matrix{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

Matrix4 multiply(const Matrix4& a, const Matrix4& b) {
  Matrix4 product{};
  for (size_t i = 0; i < 4; ++i)
    for (size_t j = 0; j < 4; ++j)
      for (size_t k = 0; k < 4; ++k) product[i][j] += a[i][k] * b[k][j];
  return product;
}

Matrix4 transpose(const Matrix4& m) {
  Matrix4 t{};
  for (size_t i = 0; i < 4; ++i)
    for (size_t j = 0; j < 4; ++j) t[i][j] = m[j][i];
  return t;
}

/// `v` divided by its length, also if the squared length is out of the range of double.
Vec3d unit(const Vec3d& v) {
  const double square = length_squared(v);
  if (square > 1e-280 && square < 1e280) return normalize(v);
  return normalize(v / std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}));
}

/// Gauss-Jordan elimination with partial pivoting.
Matrix4 invert(Matrix4 m) {
  Matrix4 inverse = identity_matrix;
  for (size_t column = 0; column < 4; ++column) {
    size_t pivot = column;
    for (size_t row = column + 1; row < 4; ++row)
      if (std::abs(m[row][column]) > std::abs(m[pivot][column])) pivot = row;
    const double diagonal = m[pivot][column];
    if (!(std::abs(diagonal) > 0) || !std::isfinite(diagonal)) throw std::domain_error("the matrix cannot be inverted");
    std::swap(m[column], m[pivot]);
    std::swap(inverse[column], inverse[pivot]);
    for (size_t j = 0; j < 4; ++j) {
      m[column][j] /= diagonal;
      inverse[column][j] /= diagonal;
    }
    for (size_t row = 0; row < 4; ++row) {
      if (row == column) continue;
      const double factor = m[row][column];
      for (size_t j = 0; j < 4; ++j) {
        m[row][j] -= factor * m[column][j];
        inverse[row][j] -= factor * inverse[column][j];
      }
    }
  }
  return inverse;
}

}  // namespace

Transform::Transform() : m_(identity_matrix), inv_(identity_matrix) {}

Transform::Transform(const Matrix4& matrix) : m_(matrix), inv_(invert(matrix)) {}

Transform Transform::translate(const Vec3d& offset) {
  Matrix4 m = identity_matrix, inv = identity_matrix;
  for (int i = 0; i < 3; ++i) {
    m[static_cast<size_t>(i)][3] = offset[i];
    inv[static_cast<size_t>(i)][3] = -offset[i];
  }
  return Transform(m, inv);
}

Transform Transform::scale(const Vec3d& factors) {
  Matrix4 m = identity_matrix;
  for (int i = 0; i < 3; ++i) m[static_cast<size_t>(i)][static_cast<size_t>(i)] = factors[i];
  return Transform(m);
}

Transform Transform::rotate(double degrees, const Vec3d& axis) {
  if (is_zero(axis)) throw std::domain_error("the axis of rotation is zero");
  const Vec3d a = unit(axis);
  const double angle = degrees * std::numbers::pi / 180;
  const double s = std::sin(angle), c = std::cos(angle), k = 1 - c;
  const Matrix4 m{{{a.x * a.x * k + c, a.x * a.y * k - a.z * s, a.x * a.z * k + a.y * s, 0},
                   {a.y * a.x * k + a.z * s, a.y * a.y * k + c, a.y * a.z * k - a.x * s, 0},
                   {a.z * a.x * k - a.y * s, a.z * a.y * k + a.x * s, a.z * a.z * k + c, 0},
                   {0, 0, 0, 1}}};
  return Transform(m, transpose(m));
}

Transform Transform::look_at(const Vec3d& eye, const Vec3d& target, const Vec3d& up) {
  const Vec3d view = target - eye;
  if (is_zero(view)) throw std::domain_error("eye and target are the same point");
  const Vec3d forward = unit(view);
  const Vec3d side = is_zero(up) ? up : cross(unit(up), forward);
  if (length(side) < 1e-12) throw std::domain_error("the up vector is parallel to the viewing direction");
  const Vec3d right = normalize(side);
  const Vec3d true_up = cross(forward, right);
  const Matrix4 world_from_camera{{{right.x, true_up.x, forward.x, eye.x},
                                   {right.y, true_up.y, forward.y, eye.y},
                                   {right.z, true_up.z, forward.z, eye.z},
                                   {0, 0, 0, 1}}};
  return Transform(world_from_camera).inverse();
}

Transform Transform::transposed() const { return Transform(transpose(m_), transpose(inv_)); }

Vec3d Transform::point(const Vec3d& p) const {
  const auto row = [&](size_t i) { return m_[i][0] * p.x + m_[i][1] * p.y + m_[i][2] * p.z + m_[i][3]; };
  const double w = row(3);
  const Vec3d q{row(0), row(1), row(2)};
  return w == 1 ? q : q / w;
}

Vec3d Transform::direction(const Vec3d& v) const {
  const auto row = [&](size_t i) { return m_[i][0] * v.x + m_[i][1] * v.y + m_[i][2] * v.z; };
  return {row(0), row(1), row(2)};
}

Vec3d Transform::normal(const Vec3d& n) const {
  const auto column = [&](size_t i) { return inv_[0][i] * n.x + inv_[1][i] * n.y + inv_[2][i] * n.z; };
  return {column(0), column(1), column(2)};
}

bool Transform::swaps_handedness() const {
  const Vec3d x = direction({1, 0, 0}), y = direction({0, 1, 0}), z = direction({0, 0, 1});
  return dot(cross(x, y), z) < 0;
}

bool Transform::is_similarity(double& scale) const {
  const Vec3d x = direction({1, 0, 0}), y = direction({0, 1, 0}), z = direction({0, 0, 1});
  scale = std::cbrt(std::abs(dot(cross(x, y), z)));
  const double s2 = scale * scale, tolerance = 1e-6 * s2;
  const auto near = [&](double value, double expected) { return std::abs(value - expected) <= tolerance; };
  return near(dot(x, x), s2) && near(dot(y, y), s2) && near(dot(z, z), s2) && near(dot(x, y), 0) &&
         near(dot(y, z), 0) && near(dot(z, x), 0) && m_[3] == identity_matrix[3];
}

bool Transform::is_identity() const { return m_ == identity_matrix; }

Transform operator*(const Transform& a, const Transform& b) {
  return Transform(multiply(a.m_, b.m_), multiply(b.inv_, a.inv_));
}

}  // namespace alhazen::impl

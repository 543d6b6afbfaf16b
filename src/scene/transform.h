#pragma once

// Affine and projective 4x4 transforms in double precision, with their inverses.

#include <array>

#include "core/math/vec.h"

namespace alhazen::impl {

/// Row-major 4x4 matrix; points are columns: p' = M p.
using Matrix4 = std::array<std::array<double, 4>, 4>;

class Transform {
 public:
  Transform();  ///< the identity
  /// Throws std::domain_error if `matrix` is singular.
  explicit Transform(const Matrix4& matrix);
  Transform(const Matrix4& matrix, const Matrix4& inverse) : m_(matrix), inv_(inverse) {}

  static Transform translate(const Vec3d& offset);
  static Transform scale(const Vec3d& factors);
  static Transform rotate(double degrees, const Vec3d& axis);
  /// Camera-from-world, left-handed as in pbrt: x right, y up, z into the scene.
  /// Throws std::domain_error if eye and target coincide or `up` is parallel to the viewing direction.
  static Transform look_at(const Vec3d& eye, const Vec3d& target, const Vec3d& up);

  const Matrix4& matrix() const { return m_; }
  Transform inverse() const { return Transform(inv_, m_); }
  Transform transposed() const;

  Vec3d point(const Vec3d& p) const;      ///< divides by w
  Vec3d direction(const Vec3d& v) const;  ///< no translation
  Vec3d normal(const Vec3d& n) const;     ///< by the inverse transpose; not normalized

  /// True if the upper 3x3 has a negative determinant, so that it swaps handedness.
  bool swaps_handedness() const;
  /// True if it is a rotation or reflection times a uniform scale, which `scale` receives.
  bool is_similarity(double& scale) const;
  bool is_identity() const;

  friend Transform operator*(const Transform& a, const Transform& b);
  friend bool operator==(const Transform& a, const Transform& b) { return a.m_ == b.m_; }

 private:
  Matrix4 m_;
  Matrix4 inv_;
};

}  // namespace alhazen::impl

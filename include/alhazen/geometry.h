#pragma once

// Points, colours and transforms of scenes. Lengths are in the scene's unit, angles in degrees.

#include <array>
#include <span>

#include "alhazen/version.h"

namespace ALHAZEN_NAMESPACE {

struct Vec2 {
  double x = 0, y = 0;
  friend constexpr bool operator==(const Vec2&, const Vec2&) = default;
};

/// A point or a direction.
struct Vec3 {
  double x = 0, y = 0, z = 0;
  friend constexpr bool operator==(const Vec3&, const Vec3&) = default;
};

/// Linear sRGB (D65). A reflectance is from 0 to 1; radiance, intensity and irradiance have no upper limit.
struct Colour {
  double r = 0, g = 0, b = 0;

  constexpr Colour() = default;
  constexpr Colour(double grey) : r(grey), g(grey), b(grey) {}  // NOLINT: a number is a grey
  constexpr Colour(double red, double green, double blue) : r(red), g(green), b(blue) {}
  friend constexpr bool operator==(const Colour&, const Colour&) = default;
};

/// An axis-aligned box.
struct Box {
  Vec3 low, high;
  constexpr bool is_empty() const { return !(low.x <= high.x && low.y <= high.y && low.z <= high.z); }
};

/// Whether x is to the right (as in glTF, OBJ and most programs) or to the left (as in pbrt) where y is up and z points
/// out of the image.
enum class Handedness { right, left };

/// Row-major; points are columns: p' = M p.
using Matrix4 = std::array<std::array<double, 4>, 4>;

/// An affine transform with its inverse. The functions that make one throw InputError that names the argument which is
/// not finite, or makes it singular.
class Transform {
 public:
  Transform();  ///< the identity

  static Transform translate(const Vec3& offset);
  static Transform scale(const Vec3& factors);
  static Transform scale(double factor);
  /// Counter-clockwise seen from the tip of `axis`, which may be of any length but 0.
  static Transform rotate(double degrees, const Vec3& axis);
  /// From camera space (x right, y up, z into the scene) to world space. `up` need not be perpendicular to the view.
  static Transform look_at(const Vec3& eye, const Vec3& target, const Vec3& up = {0, 1, 0},
                           Handedness handedness = Handedness::right);
  /// The last row must be 0, 0, 0, 1.
  static Transform from_matrix(const Matrix4& matrix);
  /// 16 values, or the 12 of the first three rows, row by row.
  static Transform from_matrix(std::span<const double> values);

  const Matrix4& matrix() const { return matrix_; }
  Transform inverse() const { return {inverse_, matrix_}; }
  Vec3 point(const Vec3& p) const;
  Vec3 direction(const Vec3& v) const;  ///< without the translation

  /// The transform that applies `b` first, then `a`.
  friend Transform operator*(const Transform& a, const Transform& b) { return product(a, b); }
  friend bool operator==(const Transform& a, const Transform& b) { return a.matrix_ == b.matrix_; }

  /// Of a matrix whose inverse is known; nothing is checked.
  Transform(const Matrix4& matrix, const Matrix4& inverse) : matrix_(matrix), inverse_(inverse) {}
  const Matrix4& inverse_matrix() const { return inverse_; }

 private:
  static Transform product(const Transform& a, const Transform& b);

  Matrix4 matrix_, inverse_;
};

/// Where something is when the shutter opens, and when it closes. In between, matrices are interpolated linearly.
struct MovingTransform {
  Transform start, end;

  MovingTransform() = default;
  MovingTransform(const Transform& still) : start(still), end(still) {}  // NOLINT: something that does not move
  MovingTransform(const Transform& at_start, const Transform& at_end) : start(at_start), end(at_end) {}
  bool is_moving() const { return !(start == end); }
  friend bool operator==(const MovingTransform&, const MovingTransform&) = default;
};

}  // namespace ALHAZEN_NAMESPACE

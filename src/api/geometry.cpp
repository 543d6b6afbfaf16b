#include "alhazen/geometry.h"

#include <cmath>
#include <stdexcept>

#include "api/arguments.h"
#include "scene/default_view.h"
#include "scene/transform.h"

namespace ALHAZEN_NAMESPACE {

namespace {

/// Throws InputError that names `argument` if the result is not finite or cannot be inverted.
template <class Make>
Transform checked_transform(const char* argument, const Make& make) {
  try {
    const Transform transform = impl::public_transform(make());
    impl::affine_transform(argument, transform);
    return transform;
  } catch (const std::domain_error&) {
    impl::refuse_argument(argument, "makes a matrix that cannot be inverted");
  }
}

}  // namespace

Transform::Transform() : Transform(impl::public_transform(impl::Transform())) {}

Transform Transform::translate(const Vec3& offset) {
  const impl::Vec3d by = impl::finite_vector("offset", offset);
  return checked_transform("offset", [&] { return impl::Transform::translate(by); });
}

Transform Transform::scale(const Vec3& factors) {
  const impl::Vec3d by = impl::finite_vector("factors", factors);
  return checked_transform("factors", [&] { return impl::Transform::scale(by); });
}

Transform Transform::scale(double factor) {
  impl::finite_number("factor", factor);
  return checked_transform("factor", [&] { return impl::Transform::scale({factor, factor, factor}); });
}

Transform Transform::rotate(double degrees, const Vec3& axis) {
  impl::finite_number("degrees", degrees);
  const impl::Vec3d about = impl::finite_vector("axis", axis);
  if (impl::is_zero(about)) impl::refuse_argument("axis", "must have a length over 0");
  return checked_transform("axis", [&] { return impl::Transform::rotate(degrees, about); });
}

Transform Transform::look_at(const Vec3& eye, const Vec3& target, const Vec3& up, Handedness handedness) {
  const impl::Vec3d from = impl::finite_vector("eye", eye), to = impl::finite_vector("target", target),
                    upward = impl::finite_vector("up", up);
  const bool is_right = impl::same_kind<Handedness>("handedness", handedness, 2) == Handedness::right;
  if (from == to) impl::refuse_argument("target", "must be another point than 'eye'");
  try {
    const impl::Transform left = impl::Transform::look_at(from, to, upward).inverse();
    // What is on the right of the image changes sides.
    const impl::Transform mirror = impl::Transform::scale({-1, 1, 1});
    const Transform transform = impl::public_transform(is_right ? left * mirror : left);
    impl::affine_transform("target", transform);
    return transform;
  } catch (const std::domain_error&) {
    impl::refuse_argument("up", "must have a length over 0, and not be parallel to the direction of view");
  }
}

Transform Transform::from_matrix(const Matrix4& matrix) {
  for (const auto& row : matrix)
    for (const double value : row) impl::finite_number("matrix", value);
  if (matrix[3] != std::array<double, 4>{0, 0, 0, 1})
    impl::refuse_argument("matrix", "must have the last row 0, 0, 0, 1");
  return checked_transform("matrix", [&] { return impl::Transform(matrix); });
}

Transform Transform::from_matrix(std::span<const double> values) {
  if (values.size() != 12 && values.size() != 16)
    impl::refuse_argument("matrix", "must have 12 or 16 values, not " + std::to_string(values.size()));
  Matrix4 matrix{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  for (size_t i = 0; i < values.size(); ++i) matrix[i / 4][i % 4] = values[i];
  return from_matrix(matrix);
}

Vec3 Transform::point(const Vec3& p) const {
  return impl::public_vector(impl::transform_of(*this).point(impl::vector_of(p)));
}

Vec3 Transform::direction(const Vec3& v) const {
  return impl::public_vector(impl::transform_of(*this).direction(impl::vector_of(v)));
}

Transform Transform::product(const Transform& a, const Transform& b) {
  return impl::public_transform(impl::transform_of(a) * impl::transform_of(b));
}

}  // namespace ALHAZEN_NAMESPACE

#include "io/mitsuba/transforms.h"

#include <cmath>
#include <stdexcept>

namespace alhazen::impl::mitsuba {

namespace {

/// Three numbers from `value`, or from `x`, `y` and `z`, which are `fallback` where they are absent.
Vec3d read_xyz(const Element& element, double fallback) {
  if (const std::string* value = element.find("value")) {
    for (const char* axis : {"x", "y", "z"})
      if (element.find(axis) != nullptr)
        fail(element.place, "<" + element.tag + "> takes either 'value' or 'x', 'y' and 'z', not both");
    return parse_three(*value, element.place, "<" + element.tag + ">");
  }
  Vec3d result = splat(fallback);
  constexpr const char* axes[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i)
    if (const std::string* value = element.find(axes[i]))
      result[i] = parse_finite(*value, element.place, std::string("'") + axes[i] + "'");
  return result;
}

Transform read_rotation(const Element& element) {
  const Vec3d axis = read_xyz(element, 0);
  if (!(length_squared(axis) > 0)) fail(element.place, "the axis of <rotate> has no length: give x, y or z");
  return Transform::rotate(parse_finite(*element.find("angle"), element.place, "'angle'"), axis);
}

Transform read_scale(const Element& element) {
  const Vec3d factors = read_xyz(element, 1);
  if (factors.x == 0 || factors.y == 0 || factors.z == 0)
    fail(element.place, "a <scale> by 0 leaves nothing: give factors other than 0");
  return Transform::scale(factors);
}

/// In object space y is up, z towards the target and x the cross product of both: to the left.
Transform read_look_at(const Element& element) {
  const auto point = [&](const char* name) {
    return parse_three(*element.find(name), element.place, std::string("'") + name + "'");
  };
  const Vec3d origin = point("origin"), target = point("target");
  const Vec3d forward = target - origin;
  // Without `up` any direction across is as good.
  const Vec3d up = element.find("up") != nullptr               ? point("up")
                   : std::abs(forward.x) > std::abs(forward.y) ? Vec3d{0, 1, 0}
                                                               : Vec3d{1, 0, 0};
  try {
    return Transform::look_at(origin, target, up).inverse();
  } catch (const std::domain_error&) {
    fail(element.place,
         "<lookat> has no direction: 'origin' and 'target' must differ, and 'up' must not point along them");
  }
}

Transform read_matrix(const Element& element) {
  const std::vector<std::string_view> words = words_of(*element.find("value"));
  if (words.size() != 16 && words.size() != 9)
    fail(element.place, "<matrix> takes 16 numbers, or 9, row by row; here are " + std::to_string(words.size()));
  const size_t side = words.size() == 16 ? 4 : 3;
  Matrix4 matrix = Transform().matrix();
  for (size_t i = 0; i < words.size(); ++i)
    matrix[i / side][i % side] = parse_finite(words[i], element.place, "<matrix>");
  if (matrix[3] != std::array<double, 4>{0, 0, 0, 1}) fail(element.place, "the last row of <matrix> must be 0 0 0 1");
  try {
    return Transform(matrix);
  } catch (const std::domain_error&) {
    fail(element.place, "<matrix> is singular: it flattens what it transforms");
  }
}

Transform read_operation(const Element& element) {
  if (element.tag == "translate") {
    check_attributes(element, {"value", "x", "y", "z"});
    return Transform::translate(read_xyz(element, 0));
  }
  if (element.tag == "rotate") {
    check_attributes(element, {"value", "x", "y", "z", "!angle"});
    return read_rotation(element);
  }
  if (element.tag == "scale") {
    check_attributes(element, {"value", "x", "y", "z"});
    return read_scale(element);
  }
  if (element.tag == "lookat" || element.tag == "lookAt") {
    check_attributes(element, {"!origin", "!target", "up"});
    return read_look_at(element);
  }
  if (element.tag == "matrix") {
    check_attributes(element, {"!value"});
    return read_matrix(element);
  }
  fail(element.place, "<" + element.tag + "> is not a transform; use translate, rotate, scale, lookat or matrix");
}

bool is_finite(const Matrix4& matrix) {
  for (const auto& row : matrix)
    for (const double value : row)
      if (!std::isfinite(value)) return false;
  return true;
}

}  // namespace

Transform read_transform(const Element& element) {
  Transform transform;
  for (const Element& operation : element.children) {
    if (!operation.children.empty())
      fail(operation.children[0].place, "<" + operation.tag + "> contains no other elements");
    transform = read_operation(operation) * transform;
  }
  if (!is_finite(transform.matrix()) || !is_finite(transform.inverse().matrix()))
    fail(element.place, "the transform exceeds double precision");
  return transform;
}

}  // namespace alhazen::impl::mitsuba

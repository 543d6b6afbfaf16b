#include "api/arguments.h"

#include <cmath>
#include <sstream>

#include "util/printable.h"

namespace alhazen::impl {

namespace {

std::string text_of(double value) {
  std::ostringstream text;
  text.precision(17);
  text << value;
  return text.str();
}

bool is_finite(const alhazen::Matrix4& matrix) {
  for (const auto& row : matrix)
    for (const double value : row)
      if (!std::isfinite(value)) return false;
  return true;
}

}  // namespace

void refuse_argument(std::string_view name, const std::string& problem) {
  throw alhazen::InputError(printable("'" + std::string(name) + "' " + problem));
}

double finite_number(std::string_view name, double value) {
  if (!std::isfinite(value)) refuse_argument(name, "must be finite, not " + text_of(value));
  return value;
}

double positive_number(std::string_view name, double value) {
  if (!(value > 0 && std::isfinite(value))) refuse_argument(name, "must be finite and over 0, not " + text_of(value));
  return value;
}

double non_negative_number(std::string_view name, double value) {
  if (!(value >= 0 && std::isfinite(value)))
    refuse_argument(name, "must be finite and not negative, not " + text_of(value));
  return value;
}

double number_between(std::string_view name, double value, double low, double high) {
  if (!(value >= low && value <= high))
    refuse_argument(name, "must be from " + text_of(low) + " to " + text_of(high) + ", not " + text_of(value));
  return value;
}

int64_t integer_between(std::string_view name, int64_t value, int64_t low, int64_t high) {
  if (value < low || value > high)
    refuse_argument(
        name, "must be from " + std::to_string(low) + " to " + std::to_string(high) + ", not " + std::to_string(value));
  return value;
}

Vec3d finite_vector(std::string_view name, const alhazen::Vec3& value) {
  for (const double v : {value.x, value.y, value.z}) finite_number(name, v);
  return vector_of(value);
}

Vec3d direction_vector(std::string_view name, const alhazen::Vec3& value) {
  const Vec3d v = finite_vector(name, value);
  const double largest = max_component(abs(v));
  if (!(largest > 0)) refuse_argument(name, "must have a length over 0");
  // Scaling keeps the square of the length within range, and what is of unit length as it is.
  const bool is_in_range = largest > 1e-100 && largest < 1e100;
  return normalize(is_in_range ? v : v / largest);
}

Vec3d light_colour(std::string_view name, const alhazen::Colour& value) {
  for (const double v : {value.r, value.g, value.b}) non_negative_number(name, v);
  return vector_of(value);
}

Transform affine_transform(std::string_view name, const alhazen::Transform& value) {
  if (!is_finite(value.matrix()) || !is_finite(value.inverse_matrix()))
    refuse_argument(name, "must be a transform whose matrix and inverse are finite");
  return transform_of(value);
}

MovingTransform moving_transform(std::string_view name, const alhazen::MovingTransform& value) {
  return {affine_transform(name, value.start), affine_transform(name, value.end)};
}

}  // namespace alhazen::impl

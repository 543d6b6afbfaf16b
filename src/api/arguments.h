#pragma once

// Checks and conversions of what callers give. Every failure is an InputError that begins with the argument's name.

#include <cstdint>
#include <string>
#include <string_view>

#include "alhazen/error.h"
#include "alhazen/geometry.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// Throws alhazen::InputError: "'ior' must be ..., not ...".
[[noreturn]] void refuse_argument(std::string_view name, const std::string& problem);

double finite_number(std::string_view name, double value);
double positive_number(std::string_view name, double value);
double non_negative_number(std::string_view name, double value);
double number_between(std::string_view name, double value, double low, double high);
int64_t integer_between(std::string_view name, int64_t value, int64_t low, int64_t high);

Vec3d finite_vector(std::string_view name, const alhazen::Vec3& value);
/// Of unit length.
Vec3d direction_vector(std::string_view name, const alhazen::Vec3& value);
/// A colour that is finite and not negative.
Vec3d light_colour(std::string_view name, const alhazen::Colour& value);
Transform affine_transform(std::string_view name, const alhazen::Transform& value);
MovingTransform moving_transform(std::string_view name, const alhazen::MovingTransform& value);

inline Vec3d vector_of(const alhazen::Vec3& v) { return {v.x, v.y, v.z}; }
inline Vec3d vector_of(const alhazen::Colour& c) { return {c.r, c.g, c.b}; }
inline alhazen::Vec3 public_vector(const Vec3d& v) { return {v.x, v.y, v.z}; }
inline alhazen::Colour public_colour(const Vec3d& v) { return {v.x, v.y, v.z}; }
inline Transform transform_of(const alhazen::Transform& t) { return {t.matrix(), t.inverse_matrix()}; }
inline alhazen::Transform public_transform(const Transform& t) { return {t.matrix(), t.inverse().matrix()}; }
inline alhazen::MovingTransform public_transform(const MovingTransform& t) {
  return {public_transform(t.start), public_transform(t.end)};
}

/// One of the first `count` values of an enumeration that two layers list in the same order.
template <class To, class From>
To same_kind(std::string_view name, From value, uint32_t count) {
  const auto number = static_cast<uint32_t>(value);
  if (number >= count) refuse_argument(name, "is none of its values");
  return static_cast<To>(number);
}

}  // namespace alhazen::impl

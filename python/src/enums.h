#pragma once

// Enumerations are str in Python: the names that they have in C++.

#include <array>
#include <string>

#include "alhazen/arrays.h"
#include "alhazen/camera.h"
#include "alhazen/geometry.h"
#include "alhazen/materials.h"
#include "alhazen/textures.h"
#include "convert.h"

namespace alhazen::python {

/// The names of an enumeration's values, in their order.
template <class Enum>
inline constexpr int enum_names = 0;
template <>
inline constexpr std::array enum_names<Handedness>{"right", "left"};
template <>
inline constexpr std::array enum_names<Encoding>{"srgb", "linear"};
template <>
inline constexpr std::array enum_names<MappingKind>{"uv", "spherical", "cylindrical", "planar"};
template <>
inline constexpr std::array enum_names<WrapMode>{"repeat", "black", "clamp", "mirror"};
template <>
inline constexpr std::array enum_names<CameraKind>{"perspective", "orthographic", "equirectangular", "equal_area"};
template <>
inline constexpr std::array enum_names<FilterKind>{"box", "triangle", "gaussian", "mitchell", "sinc"};
template <>
inline constexpr std::array enum_names<Integrator>{"path", "iterative", "recursive", "branching"};
template <>
inline constexpr std::array enum_names<Sampler>{"sobol", "zsobol", "independent"};
template <>
inline constexpr std::array enum_names<Metal>{"silver",          "aluminium",       "gold", "copper", "brass",
                                              "magnesium_oxide", "titanium_dioxide"};

/// "one of 'a', 'b' and 'c'".
template <class Enum>
std::string enum_choice() {
  std::string list = "one of ";
  const auto& names = enum_names<Enum>;
  for (size_t i = 0; i < names.size(); ++i)
    list += (i == 0 ? "'" : i + 1 < names.size() ? ", '" : " and '") + std::string(names[i]) + "'";
  return list;
}

/// Takes a str, or a member of an enum.Enum by its name.
template <class Enum>
Enum enum_value(const std::string& argument, py::handle given) {
  py::object named = py::reinterpret_borrow<py::object>(given);
  if (!PyUnicode_Check(given.ptr()) && py::hasattr(given, "name")) named = given.attr("name");
  if (PyUnicode_Check(named.ptr())) {
    const std::string name = text(argument, named);
    for (size_t i = 0; i < enum_names<Enum>.size(); ++i)
      if (name == enum_names<Enum>[i]) return static_cast<Enum>(i);
  }
  refuse_given(argument, enum_choice<Enum>(), given);
}

template <class Enum>
py::str enum_name(Enum value) {
  return enum_names<Enum>[static_cast<size_t>(value)];
}

template <class Type>
concept NamedEnum = requires {
  enum_names<Type>.size();
};

}  // namespace alhazen::python

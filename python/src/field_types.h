#pragma once

// How each type of the library's structs is taken from Python and shown: FieldType<T>.

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "alhazen/materials.h"
#include "alhazen/shapes.h"
#include "convert.h"
#include "enums.h"
#include "value.h"

namespace alhazen::python {

template <class T>
struct FieldType;

template <>
struct FieldType<double> {
  static std::string type() { return "float"; }
  static double read(const std::string& name, py::handle given) { return number(name, given); }
  static py::object show(double value) { return py::float_(value); }
};

template <>
struct FieldType<bool> {
  static std::string type() { return "bool"; }
  static bool read(const std::string& name, py::handle given) { return flag(name, given); }
  static py::object show(bool value) { return py::bool_(value); }
};

template <class Integer>
requires std::is_integral_v<Integer>
struct FieldType<Integer> {
  static std::string type() { return "int"; }
  static Integer read(const std::string& name, py::handle given) {
    return static_cast<Integer>(
        integer(name, given, std::numeric_limits<Integer>::min(), std::numeric_limits<Integer>::max()));
  }
  static py::object show(Integer value) { return py::int_(value); }
};

template <>
struct FieldType<std::string> {
  static std::string type() { return "str"; }
  static std::string read(const std::string& name, py::handle given) { return text(name, given); }
  static py::object show(const std::string& value) { return path_text(value); }
};

template <>
struct FieldType<Vec2> {
  static std::string type() { return "tuple[float, float]"; }
  static Vec2 read(const std::string& name, py::handle given) { return vector2(name, given); }
  static py::object show(const Vec2& value) { return shown(value); }
};

template <>
struct FieldType<Vec3> {
  static std::string type() { return "tuple[float, float, float]"; }
  static Vec3 read(const std::string& name, py::handle given) { return vector3(name, given); }
  static py::object show(const Vec3& value) { return shown(value); }
};

template <>
struct FieldType<Colour> {
  static std::string type() { return "color"; }
  static Colour read(const std::string& name, py::handle given) { return colour(name, given); }
  static py::object show(const Colour& value) { return shown(value); }
};

template <>
struct FieldType<Axes> {
  static std::string type() { return "3x3 array"; }
  static Axes read(const std::string& name, py::handle given) { return axes(name, given); }
  static py::object show(const Axes& value) { return shown(value); }
};

template <>
struct FieldType<Transform> {
  static std::string type() { return "4x4 array"; }
  static Transform read(const std::string& name, py::handle given) { return transform(name, given); }
  static py::object show(const Transform& value) { return shown(value); }
};

template <>
struct FieldType<MovingTransform> {
  static std::string type() { return "4x4 array | MovingTransform"; }
  static MovingTransform read(const std::string& name, py::handle given) { return moving_transform(name, given); }
  static py::object show(const MovingTransform& value) {
    return value.is_moving() ? py::cast(value) : py::object(shown(value.start));
  }
};

template <NamedEnum Enum>
struct FieldType<Enum> {
  static std::string type() { return "str"; }
  static Enum read(const std::string& name, py::handle given) { return enum_value<Enum>(name, given); }
  static py::object show(Enum value) { return enum_name(value); }
};

template <class Number, size_t Count>
requires std::is_arithmetic_v<Number>
struct FieldType<std::array<Number, Count>> {
  static std::string type() { return "tuple of " + std::to_string(Count); }
  static std::array<Number, Count> read(const std::string& name, py::handle given) {
    const std::string wanted = std::to_string(Count) + " numbers";
    if (!is_sequence(given) || py::len(given) != Count) refuse_given(name, wanted, given);
    std::array<Number, Count> values;
    for (size_t i = 0; i < Count; ++i) values[i] = FieldType<Number>::read(name, py::object(given[py::int_(i)]));
    return values;
  }
  static py::object show(const std::array<Number, Count>& values) {
    py::tuple result(Count);
    for (size_t i = 0; i < Count; ++i) result[i] = FieldType<Number>::show(values[i]);
    return result;
  }
};

// Inputs, which may be textures. -------------------------------------------------------------------------------------

/// Texture values and textures of a scene as they are kept; null for all else.
py::object keep_texture(const std::string& name, py::handle given);
TextureId resolve_texture(const std::string& name, py::handle kept, alhazen::Scene& scene);
py::object lift_texture(const std::shared_ptr<PythonScene>& scene, TextureId texture);

/// Each type of a field that can refer to parts has, besides what Field says, a placeholder: a value that the library
/// takes, which stands in the struct for as long as the part is in no scene.
template <class Input>
struct InputType {
  static Input placeholder() { return 0.5; }
  static py::object keep(const std::string& name, py::handle given) { return keep_texture(name, given); }
  static Input resolve(const std::string& name, py::handle kept, alhazen::Scene& scene) {
    return resolve_texture(name, kept, scene);
  }
  static py::object lift(const std::shared_ptr<PythonScene>& scene, const Input& input) {
    return input.is_texture() ? lift_texture(scene, input.texture()) : py::object();
  }
};

template <>
struct FieldType<ColourInput> : InputType<ColourInput> {
  static std::string type() { return "color | Texture"; }
  static ColourInput read(const std::string& name, py::handle given) { return colour(name, given); }
  static py::object show(const ColourInput& value) { return shown(value.colour()); }
};

template <>
struct FieldType<NumberInput> : InputType<NumberInput> {
  static std::string type() { return "float | Texture"; }
  static NumberInput read(const std::string& name, py::handle given) { return number(name, given); }
  static py::object show(const NumberInput& value) { return py::float_(value.number()); }
};

template <>
struct FieldType<TextureId> {
  static std::string type() { return "Texture | None"; }
  static TextureId read(const std::string& name, py::handle given) {
    if (!given.is_none()) refuse_given(name, "a texture or None", given);
    return {};
  }
  static py::object show(TextureId) { return py::none(); }
  static TextureId placeholder() { return {}; }
  static py::object keep(const std::string& name, py::handle given) { return keep_texture(name, given); }
  static TextureId resolve(const std::string& name, py::handle kept, alhazen::Scene& scene) {
    return resolve_texture(name, kept, scene);
  }
  static py::object lift(const std::shared_ptr<PythonScene>& scene, TextureId texture) {
    return texture ? lift_texture(scene, texture) : py::object();
  }
};

/// Defined where images and materials are.
template <>
struct FieldType<ImageId> {
  static std::string type() { return "Image | array | str"; }
  static ImageId read(const std::string& name, py::handle given);
  static py::object show(ImageId) { return py::none(); }
  static ImageId placeholder() { return {}; }
  static py::object keep(const std::string& name, py::handle given);
  static ImageId resolve(const std::string& name, py::handle kept, alhazen::Scene& scene);
  static py::object lift(const std::shared_ptr<PythonScene>& scene, ImageId image);
};

template <>
struct FieldType<std::array<MaterialId, 2>> {
  static std::string type() { return "tuple[Material, Material]"; }
  static std::array<MaterialId, 2> read(const std::string& name, py::handle given);
  static py::object show(const std::array<MaterialId, 2>&) { return py::none(); }
  static std::array<MaterialId, 2> placeholder() { return {}; }
  static py::object keep(const std::string& name, py::handle given);
  static std::array<MaterialId, 2> resolve(const std::string& name, py::handle kept, alhazen::Scene& scene);
  static py::object lift(const std::shared_ptr<PythonScene>& scene, const std::array<MaterialId, 2>& materials);
};

/// A number or a texture is the same along u and v; two are along u and v.
template <>
struct FieldType<Roughness> {
  static std::string type() { return "float | Texture | Roughness"; }
  static Roughness read(const std::string& name, py::handle given) { return number(name, given); }
  static py::object show(const Roughness& value);
  static Roughness placeholder() { return {}; }
  static py::object keep(const std::string& name, py::handle given);
  static Roughness resolve(const std::string& name, py::handle kept, alhazen::Scene& scene);
  static py::object lift(const std::shared_ptr<PythonScene>& scene, const Roughness& roughness);
};

template <>
struct FieldType<TextureMapping> {
  static std::string type() { return "Mapping"; }
  static TextureMapping read(const std::string& name, py::handle given);
  static py::object show(const TextureMapping& value);
};

template <class T>
concept RefersToParts = requires(const std::string& name, py::handle given) {
  FieldType<T>::keep(name, given);
};

template <class T>
struct FieldType<std::optional<T>> {
  static std::string type() { return FieldType<T>::type() + " | None"; }
  static std::optional<T> read(const std::string& name, py::handle given) {
    if (given.is_none()) return {};
    return FieldType<T>::read(name, given);
  }
  static py::object show(const std::optional<T>& value) { return value ? FieldType<T>::show(*value) : py::none(); }
  static std::optional<T> placeholder() requires RefersToParts<T> { return FieldType<T>::placeholder(); }
  static py::object keep(const std::string& name, py::handle given) requires RefersToParts<T> {
    return FieldType<T>::keep(name, given);
  }
  static std::optional<T> resolve(const std::string& name, py::handle kept,
                                  alhazen::Scene& scene) requires RefersToParts<T> {
    return FieldType<T>::resolve(name, kept, scene);
  }
  static py::object lift(const std::shared_ptr<PythonScene>& scene,
                         const std::optional<T>& value) requires RefersToParts<T> {
    return value ? FieldType<T>::lift(scene, *value) : py::object();
  }
};

}  // namespace alhazen::python

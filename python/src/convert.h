#pragma once

// What Python gives, as numbers, texts, vectors and transforms of C++, and back. What does not fit is an InputError
// that names the argument: "'fov' must be a number, not 'wide'".

#include <pybind11/numpy.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "alhazen/geometry.h"
#include "alhazen/lights.h"
#include "bindings.h"

namespace alhazen::python {

/// Throws InputError: "'name' problem".
[[noreturn]] void refuse(const std::string& name, const std::string& problem);
/// The same, with what was given: "'name' must be wanted, not given".
[[noreturn]] void refuse_given(const std::string& name, const std::string& wanted, py::handle given);

/// The repr, shortened; never throws for what an object's own code raises.
std::string short_repr(py::handle object);

/// float, int and NumPy's numbers, neither bool nor text.
double number(const std::string& name, py::handle given);
/// int and NumPy's integers.
int64_t integer(const std::string& name, py::handle given, int64_t low, int64_t high);
/// bool and NumPy's.
bool flag(const std::string& name, py::handle given);
/// str, in UTF-8.
std::string text(const std::string& name, py::handle given);
/// str, bytes or os.PathLike, as the file system has it.
std::string file_name(const std::string& name, py::handle given);
bool is_file_name(py::handle given);
/// The reverse: what the file system has, and other bytes of the library, as str.
py::str path_text(const std::string& bytes);

/// `count` numbers of a list, tuple, array or another sequence.
std::vector<double> numbers(const std::string& name, py::handle given, size_t count, const char* wanted);
bool is_sequence(py::handle given);

Vec2 vector2(const std::string& name, py::handle given);
Vec3 vector3(const std::string& name, py::handle given);
/// A number, which is a grey, or three.
Colour colour(const std::string& name, py::handle given);
/// Three rows of three numbers.
Axes axes(const std::string& name, py::handle given);

/// A Transform, or an array of the shape (4, 4) or (3, 4).
Transform transform(const std::string& name, py::handle given);
/// The same, or a MovingTransform.
MovingTransform moving_transform(const std::string& name, py::handle given);

py::object shown(const Vec2& v);
py::object shown(const Vec3& v);
py::object shown(const Colour& c);
py::object shown(const Axes& axes);
/// A read-only array of the shape (4, 4): a change of it would be lost.
py::array shown(const Transform& transform);

/// `array`, read-only.
py::array read_only(py::array array);

}  // namespace alhazen::python

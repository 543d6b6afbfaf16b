#include "convert.h"

#include <limits>

#include "alhazen/error.h"

namespace alhazen::python {

namespace {

constexpr size_t max_repr = 80;

bool is_bool(py::handle given) {
  return PyBool_Check(given.ptr()) || std::string_view(Py_TYPE(given.ptr())->tp_name) == "numpy.bool_";
}

bool is_text(py::handle given) { return PyUnicode_Check(given.ptr()) || PyBytes_Check(given.ptr()); }

/// An array with dimensions has __float__ and __index__ as well, if it holds one number.
bool is_array(py::handle given) {
  return py::isinstance<py::array>(given) && py::reinterpret_borrow<py::array>(given).ndim() > 0;
}

}  // namespace

void refuse(const std::string& name, const std::string& problem) { throw InputError("'" + name + "' " + problem); }

void refuse_given(const std::string& name, const std::string& wanted, py::handle given) {
  refuse(name, "must be " + wanted + ", not " + short_repr(given));
}

std::string short_repr(py::handle object) {
  try {
    // Of arrays and other large things, the type says more.
    if (py::isinstance<py::array>(object)) {
      const auto array = py::reinterpret_borrow<py::array>(object);
      return "an array of the shape " + std::string(py::str(array.attr("shape"))) + " and dtype " +
             std::string(py::str(array.dtype()));
    }
    std::string text = py::repr(object);
    for (char& c : text)
      if (c == '\n' || c == '\r') c = ' ';
    if (text.size() <= max_repr) return text;
    size_t end = max_repr;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;  // whole characters of UTF-8
    return text.substr(0, end) + "...";
  } catch (const std::exception&) {
    PyErr_Clear();
    return std::string("an object of the type ") + Py_TYPE(object.ptr())->tp_name;
  }
}

double number(const std::string& name, py::handle given) {
  if (is_bool(given) || is_text(given) || is_array(given) ||
      (!PyFloat_Check(given.ptr()) && !PyIndex_Check(given.ptr()) &&
       (Py_TYPE(given.ptr())->tp_as_number == nullptr || Py_TYPE(given.ptr())->tp_as_number->nb_float == nullptr)))
    refuse_given(name, "a number", given);
  const double value = PyFloat_AsDouble(given.ptr());
  if (PyErr_Occurred() != nullptr) {
    PyErr_Clear();  // an int beyond the range, or a complex number of NumPy
    refuse_given(name, "a number that a float can hold", given);
  }
  return value;
}

int64_t integer(const std::string& name, py::handle given, int64_t low, int64_t high) {
  if (is_bool(given) || is_array(given) || !PyIndex_Check(given.ptr())) refuse_given(name, "an int", given);
  const py::object index = py::reinterpret_steal<py::object>(PyNumber_Index(given.ptr()));
  if (!index) {
    PyErr_Clear();
    refuse_given(name, "an int", given);
  }
  int overflow = 0;
  const long long value = PyLong_AsLongLongAndOverflow(index.ptr(), &overflow);
  if (overflow != 0 || value < low || value > high)
    refuse_given(name, "from " + std::to_string(low) + " to " + std::to_string(high), given);
  return value;
}

bool flag(const std::string& name, py::handle given) {
  if (!is_bool(given)) refuse_given(name, "True or False", given);
  return PyObject_IsTrue(given.ptr()) == 1;
}

std::string text(const std::string& name, py::handle given) {
  if (!PyUnicode_Check(given.ptr())) refuse_given(name, "a str", given);
  Py_ssize_t size = 0;
  const char* utf8 = PyUnicode_AsUTF8AndSize(given.ptr(), &size);
  if (utf8 == nullptr) {
    PyErr_Clear();
    refuse_given(name, "a str without lone surrogates", given);
  }
  return {utf8, static_cast<size_t>(size)};
}

bool is_file_name(py::handle given) { return is_text(given) || py::hasattr(given, "__fspath__"); }

std::string file_name(const std::string& name, py::handle given) {
  PyObject* bytes = nullptr;
  if (!is_file_name(given) || PyUnicode_FSConverter(given.ptr(), &bytes) == 0) {
    PyErr_Clear();
    refuse_given(name, "the name of a file, a str or os.PathLike", given);
  }
  const py::object owner = py::reinterpret_steal<py::object>(bytes);
  std::string file(PyBytes_AS_STRING(bytes), static_cast<size_t>(PyBytes_GET_SIZE(bytes)));
  if (file.empty()) refuse(name, "must not be empty");
  return file;
}

py::str path_text(const std::string& bytes) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), "surrogateescape"));
}

bool is_sequence(py::handle given) {
  if (is_text(given) || PyDict_Check(given.ptr()) || PyAnySet_Check(given.ptr())) return false;
  if (py::isinstance<py::array>(given)) return is_array(given);
  return PySequence_Check(given.ptr()) == 1;
}

std::vector<double> numbers(const std::string& name, py::handle given, size_t count, const char* wanted) {
  if (!is_sequence(given)) refuse_given(name, wanted, given);
  const py::object items = py::reinterpret_steal<py::object>(PySequence_List(given.ptr()));
  if (!items) {
    PyErr_Clear();
    refuse_given(name, wanted, given);
  }
  const auto list = py::reinterpret_borrow<py::list>(items);
  if (list.size() != count) refuse_given(name, wanted, given);
  std::vector<double> values;
  for (const py::handle item : list) values.push_back(number(name, item));
  return values;
}

Vec2 vector2(const std::string& name, py::handle given) {
  const std::vector<double> v = numbers(name, given, 2, "two numbers");
  return {v[0], v[1]};
}

Vec3 vector3(const std::string& name, py::handle given) {
  const std::vector<double> v = numbers(name, given, 3, "three numbers");
  return {v[0], v[1], v[2]};
}

Colour colour(const std::string& name, py::handle given) {
  constexpr const char* wanted = "a color: a number or three numbers";
  if (is_sequence(given)) {
    const std::vector<double> v = numbers(name, given, 3, wanted);
    return {v[0], v[1], v[2]};
  }
  if (is_text(given) || given.is_none()) refuse_given(name, wanted, given);
  return Colour(number(name, given));
}

Axes axes(const std::string& name, py::handle given) {
  constexpr const char* wanted = "three axes of three numbers each";
  if (!is_sequence(given) || py::len(given) != 3) refuse_given(name, wanted, given);
  const auto row = [&](size_t i) {
    const std::vector<double> v = numbers(name, py::object(given[py::int_(i)]), 3, wanted);
    return Vec3{v[0], v[1], v[2]};
  };
  return {row(0), row(1), row(2)};
}

Transform transform(const std::string& name, py::handle given) {
  constexpr const char* wanted = "a Transform or a matrix of the shape (4, 4)";
  if (py::isinstance<Transform>(given)) return given.cast<Transform>();
  if (!is_sequence(given)) refuse_given(name, wanted, given);
  const Py_ssize_t rows = PySequence_Size(given.ptr());
  if (rows < 0) PyErr_Clear();
  if (rows != 3 && rows != 4) refuse_given(name, wanted, given);
  std::vector<double> values;
  for (Py_ssize_t i = 0; i < rows; ++i) {
    const std::vector<double> row = numbers(name, py::object(given[py::int_(i)]), 4, wanted);
    values.insert(values.end(), row.begin(), row.end());
  }
  try {
    return Transform::from_matrix(values);
  } catch (const InputError& error) {
    // It speaks of 'matrix'.
    const std::string problem = error.what(), argument = "'matrix' ";
    refuse(name, problem.starts_with(argument) ? problem.substr(argument.size()) : problem);
  }
}

MovingTransform moving_transform(const std::string& name, py::handle given) {
  if (py::isinstance<MovingTransform>(given)) return given.cast<MovingTransform>();
  return transform(name, given);
}

py::object shown(const Vec2& v) { return py::make_tuple(v.x, v.y); }
py::object shown(const Vec3& v) { return py::make_tuple(v.x, v.y, v.z); }
py::object shown(const Colour& c) { return py::make_tuple(c.r, c.g, c.b); }
py::object shown(const Axes& axes) { return py::make_tuple(shown(axes.x), shown(axes.y), shown(axes.z)); }

py::array shown(const Transform& transform) {
  py::array_t<double> matrix({4, 4});
  for (py::ssize_t i = 0; i < 4; ++i)
    for (py::ssize_t j = 0; j < 4; ++j)
      matrix.mutable_at(i, j) = transform.matrix()[static_cast<size_t>(i)][static_cast<size_t>(j)];
  return read_only(matrix);
}

py::array read_only(py::array array) {
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

}  // namespace alhazen::python

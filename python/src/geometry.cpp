// Transform, MovingTransform and Box.

#include "alhazen/geometry.h"

#include <optional>

#include "bindings.h"
#include "convert.h"
#include "enums.h"

namespace alhazen::python {

namespace {

py::object as_array(const py::array& matrix, const py::object& dtype, const py::object& copy) {
  const py::object numpy = py::module_::import("numpy");
  if (dtype.is_none() && (copy.is_none() || !copy.cast<bool>())) return matrix;
  return numpy.attr("array")(matrix, py::arg("dtype") = dtype);
}

/// What numpy.asarray calls.
template <class Class, class Make>
void bind_array(Class& bound, const Make& make) {
  bound.def(
      "__array__",
      [make](const typename Class::type& self, const py::object& dtype, const py::object& copy) {
        return as_array(make(self), dtype, copy);
      },
      py::arg("dtype") = py::none(), py::arg("copy") = py::none());
}

std::string matrix_text(const Transform& t) { return py::str(py::repr(shown(t).attr("tolist")())); }

void bind_transform(py::module_& m) {
  py::class_<Transform> bound(
      m, "Transform",
      "An affine transform with its inverse: a 4x4 matrix that is applied to columns, p' = M p.\n\n"
      "Wherever a transform is taken, an array of the shape (4, 4) does as well. `a @ b` applies b first, then a.");
  py::options options;
  options.disable_function_signatures();
  bound
      .def(py::init(
               [](const py::object& matrix) { return matrix.is_none() ? Transform() : transform("matrix", matrix); }),
           py::arg("matrix") = py::none(),
           "__init__(self, matrix: array of the shape (4, 4) or (3, 4) | None = None)\n\n"
           "The identity without a matrix. The last row must be 0, 0, 0, 1. InputError: the matrix is not finite, or\n"
           "cannot be inverted.")
      .def_static(
          "translate", [](const py::object& offset) { return Transform::translate(vector3("offset", offset)); },
          py::arg("offset"), "translate(offset: 3 numbers) -> Transform\n\nMoves by the offset, in scene units.")
      .def_static(
          "scale",
          [](const py::object& factors) {
            if (is_sequence(factors)) return Transform::scale(vector3("factors", factors));
            return Transform::scale(number("factors", factors));
          },
          py::arg("factors"),
          "scale(factors: float | 3 numbers) -> Transform\n\nScales about the origin, along x, y and z. None may be 0.")
      .def_static(
          "rotate",
          [](const py::object& degrees, const py::object& axis) {
            return Transform::rotate(number("degrees", degrees), vector3("axis", axis));
          },
          py::arg("degrees"), py::arg("axis"),
          "rotate(degrees: float, axis: 3 numbers) -> Transform\n\n"
          "Rotates about an axis through the origin, counter-clockwise seen from its tip. It may be of any length but "
          "0.")
      .def_static(
          "look_at",
          [](const py::object& eye, const py::object& target, const py::object& up, const py::object& handedness) {
            return Transform::look_at(vector3("eye", eye), vector3("target", target), vector3("up", up),
                                      enum_value<Handedness>("handedness", handedness));
          },
          py::arg("eye"), py::arg("target"), py::arg("up") = py::make_tuple(0.0, 1.0, 0.0),
          py::arg("handedness") = "right",
          "look_at(eye: 3 numbers, target: 3 numbers, up: 3 numbers = (0, 1, 0), handedness: str = 'right') -> "
          "Transform\n\n"
          "From camera space (x right, y up, z into the scene) to world space. `up` need not be perpendicular to the\n"
          "view. handedness: 'right' as of glTF and most programs, or 'left' as of pbrt.")
      .def_property_readonly(
          "matrix", [](const Transform& self) { return shown(self); },
          "The matrix, a read-only array of the shape (4, 4).")
      .def("inverse", &Transform::inverse, "inverse() -> Transform")
      .def(
          "point", [](const Transform& self, const py::object& p) { return shown(self.point(vector3("point", p))); },
          py::arg("point"), "point(point: 3 numbers) -> tuple\n\nThe point, transformed.")
      .def(
          "direction",
          [](const Transform& self, const py::object& v) { return shown(self.direction(vector3("direction", v))); },
          py::arg("direction"),
          "direction(direction: 3 numbers) -> tuple\n\nThe direction, transformed without the translation.")
      .def("__matmul__",
           [](const Transform& self, const py::object& other) { return self * transform("other", other); })
      .def("__rmatmul__",
           [](const Transform& self, const py::object& other) { return transform("other", other) * self; })
      .def("__eq__",
           [](const Transform& self, const py::object& other) -> py::object {
             if (!py::isinstance<Transform>(other)) return py::reinterpret_borrow<py::object>(Py_NotImplemented);
             return py::bool_(self == other.cast<const Transform&>());
           })
      .def("__copy__", [](const Transform& self) { return self; })
      .def("__deepcopy__", [](const Transform& self, const py::object&) { return self; })
      .def("__repr__", [](const Transform& self) { return "alhazen.Transform(" + matrix_text(self) + ")"; });
  bind_array(bound, [](const Transform& self) { return shown(self); });
  bound.attr("__hash__") = py::none();
  // numpy_array @ transform asks the transform.
  bound.attr("__array_ufunc__") = py::none();
}

void bind_moving_transform(py::module_& m) {
  py::class_<MovingTransform> bound(
      m, "MovingTransform",
      "Where something is when the shutter opens, and when it closes. In between, matrices are interpolated linearly.");
  py::options options;
  options.disable_function_signatures();
  bound
      .def(py::init([](const py::object& start, const py::object& end) {
             return MovingTransform(transform("start", start), transform("end", end));
           }),
           py::arg("start"), py::arg("end"), "__init__(self, start: Transform | 4x4 array, end: Transform | 4x4 array)")
      .def_property_readonly(
          "start", [](const MovingTransform& self) { return shown(self.start); },
          "When the shutter opens: a read-only array of the shape (4, 4).")
      .def_property_readonly(
          "end", [](const MovingTransform& self) { return shown(self.end); },
          "When the shutter closes: a read-only array of the shape (4, 4).")
      .def_property_readonly("is_moving", &MovingTransform::is_moving, "Whether start and end differ.")
      .def("__eq__",
           [](const MovingTransform& self, const py::object& other) -> py::object {
             if (!py::isinstance<MovingTransform>(other)) return py::reinterpret_borrow<py::object>(Py_NotImplemented);
             return py::bool_(self == other.cast<const MovingTransform&>());
           })
      .def("__copy__", [](const MovingTransform& self) { return self; })
      .def("__deepcopy__", [](const MovingTransform& self, const py::object&) { return self; })
      .def("__repr__", [](const MovingTransform& self) {
        return "alhazen.MovingTransform(" + matrix_text(self.start) + ", " + matrix_text(self.end) + ")";
      });
  bound.attr("__hash__") = py::none();
}

py::array corners(const Box& box) {
  py::array_t<double> array({2, 3});
  for (py::ssize_t i = 0; i < 2; ++i) {
    const Vec3& corner = i == 0 ? box.low : box.high;
    array.mutable_at(i, 0) = corner.x;
    array.mutable_at(i, 1) = corner.y;
    array.mutable_at(i, 2) = corner.z;
  }
  return read_only(array);
}

void bind_box(py::module_& m) {
  py::class_<Box> bound(m, "Box",
                        "An axis-aligned box, such as the bounds of a scene. numpy.asarray(box) has the shape (2, 3).\n"
                        "That of nothing is empty: its low is infinity and its high -infinity.");
  py::options options;
  options.disable_function_signatures();
  bound
      .def_property_readonly(
          "low", [](const Box& self) { return shown(self.low); }, "The lower corner: x, y, z.")
      .def_property_readonly(
          "high", [](const Box& self) { return shown(self.high); }, "The upper corner: x, y, z.")
      .def_property_readonly(
          "center",
          [](const Box& self) {
            return py::make_tuple((self.low.x + self.high.x) / 2, (self.low.y + self.high.y) / 2,
                                  (self.low.z + self.high.z) / 2);
          },
          "The middle: x, y, z; NaN if the box is empty.")
      .def_property_readonly(
          "extents",
          [](const Box& self) {
            if (self.is_empty()) return py::make_tuple(0.0, 0.0, 0.0);
            return py::make_tuple(self.high.x - self.low.x, self.high.y - self.low.y, self.high.z - self.low.z);
          },
          "Its size along x, y and z; 0 if the box is empty.")
      .def_property_readonly("is_empty", &Box::is_empty, "Whether it contains nothing.")
      .def("__repr__", [](const Box& self) {
        if (self.is_empty()) return std::string("<alhazen.Box: empty>");
        return "<alhazen.Box from " + std::string(py::str(shown(self.low))) + " to " +
               std::string(py::str(shown(self.high))) + ">";
      });
  bind_array(bound, &corners);
}

}  // namespace

void bind_geometry(py::module_& m) {
  bind_transform(m);
  bind_moving_transform(m);
  bind_box(m);
}

}  // namespace alhazen::python

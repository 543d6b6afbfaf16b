#pragma once

// What the classes of all parts of scenes have in common.

#include <functional>
#include <string>

#include "convert.h"
#include "parts.h"

namespace alhazen::python {

/// "<alhazen.SceneMesh 'chair'>".
template <class AnyPart>
std::string part_repr(const AnyPart& self, const char* class_name, const std::string& more = {}) {
  std::string text = "<alhazen." + std::string(class_name);
  try {
    if (const std::string name = self.scene->read().name(self.id); !name.empty())
      text += " " + std::string(py::str(py::repr(path_text(name))));
    text += more;
  } catch (const Error&) {
    text += ": removed";
  }
  return text + ">";
}

/// ==, hash, scene and the name, which `rename` sets.
template <class AnyPart, class... Options>
void bind_part(py::class_<AnyPart, Options...>& bound,
               const std::function<void(const AnyPart& part, const std::string& name)>& rename) {
  bound
      .def("__eq__",
           [](const AnyPart& self, const py::object& other) -> py::object {
             if (!py::isinstance<AnyPart>(other)) return py::reinterpret_borrow<py::object>(Py_NotImplemented);
             const auto& part = other.cast<const AnyPart&>();
             return py::bool_(self.scene == part.scene && self.id == part.id);
           })
      .def("__hash__", [](const AnyPart& self) { return std::hash<decltype(self.id)>{}(self.id); })
      .def("__copy__", [](const AnyPart& self) { return self; })
      .def("__deepcopy__",
           [](const AnyPart&, const py::object&) -> py::object {
             throw py::type_error("a part of a scene cannot be copied by itself: copy its value, or the scene");
           })
      .def_property_readonly(
          "scene", [](const AnyPart& self) { return self.scene; }, "The Scene that it is a part of.");
  const char* doc = "str: as it is called in layers and reports; parts without a name by their kind and a number.";
  const auto get = [](const AnyPart& self) { return path_text(self.scene->read().name(self.id)); };
  if (rename)
    bound.def_property(
        "name", get, [rename](const AnyPart& self, const py::object& given) { rename(self, text("name", given)); },
        doc);
  else
    bound.def_property_readonly("name", get, doc);
}

}  // namespace alhazen::python

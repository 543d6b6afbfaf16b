#pragma once

// What the files of the extension have in common: each binds a part of the module.

#include <pybind11/pybind11.h>

namespace alhazen::python {

namespace py = pybind11;

void bind_errors(py::module_& m);
void bind_values(py::module_& m);
void bind_scene(py::module_& m);
void bind_render(py::module_& m);
void bind_queries(py::module_& m);
void bind_tools(py::module_& m);

}  // namespace alhazen::python

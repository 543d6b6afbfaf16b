// The extension _alhazen, all of which the package alhazen shows as its own.

#include "alhazen/alhazen.h"
#include "bindings.h"

namespace {

/// What classes inherit for making an instance. pybind11's own throws through Python for its base class, of which
/// pickle makes an instance in the protocols 0 and 1.
PyObject* new_instance(PyTypeObject* type, PyObject*, PyObject*) {
  try {
    return pybind11::detail::make_new_instance(type);
  } catch (const std::exception&) {
    PyErr_Format(PyExc_TypeError, "%s has no instances of its own; pickle needs protocol 2 or higher", type->tp_name);
    return nullptr;
  }
}

}  // namespace

PYBIND11_MODULE(_alhazen, m) {
  using namespace alhazen::python;
  reinterpret_cast<PyTypeObject*>(pybind11::detail::get_internals().instance_base)->tp_new = new_instance;
  m.doc() = "The extension behind the package alhazen.";
  // Classes and functions take the name of their module from here: to users they are alhazen.NAME.
  const py::object name = m.attr("__name__");
  m.attr("__name__") = "alhazen";
  m.attr("__version__") = alhazen::version();
  bind_errors(m);
  bind_values(m);
  bind_scene(m);
  bind_render(m);
  bind_queries(m);
  bind_tools(m);
  m.attr("__name__") = name;
}

// The extension _alhazen, all of which the package alhazen shows as its own.

#include "alhazen/alhazen.h"
#include "bindings.h"

PYBIND11_MODULE(_alhazen, m) {
  using namespace alhazen::python;
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

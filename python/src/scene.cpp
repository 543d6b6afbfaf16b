// alhazen.Scene.

#include "bindings.h"
#include "python_scene.h"

namespace alhazen::python {

void bind_scene(py::module_& m) {
  py::class_<PythonScene, std::shared_ptr<PythonScene>>(m, "Scene").def(py::init<>());
  m.def(
      "load", [](const std::string& file) { return std::make_shared<PythonScene>(alhazen::Scene::load(file)); },
      py::call_guard<py::gil_scoped_release>());
}

}  // namespace alhazen::python

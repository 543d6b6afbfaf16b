#include "bindings.h"

namespace alhazen::python {

void bind_render(py::module_&) {}

}  // namespace alhazen::python

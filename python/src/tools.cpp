#include "bindings.h"

namespace alhazen::python {

void bind_tools(py::module_&) {}

}  // namespace alhazen::python

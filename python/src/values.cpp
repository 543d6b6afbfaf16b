#include "bindings.h"

namespace alhazen::python {

void bind_values(py::module_&) {}

}  // namespace alhazen::python

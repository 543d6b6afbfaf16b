#include "bindings.h"

namespace alhazen::python {

void bind_queries(py::module_&) {}

}  // namespace alhazen::python

#pragma once

#include "bindings.h"

namespace alhazen::python {

void bind_renderer(py::module_& m);

}  // namespace alhazen::python

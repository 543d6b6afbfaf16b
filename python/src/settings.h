#pragma once

// alhazen.Settings: how to render, as a class and as keyword arguments.

#include <string>

#include "alhazen/alhazen.h"
#include "bindings.h"

namespace alhazen::python {

/// Copies `base`, an alhazen.Settings or None, and sets what `keywords` name. Throws TypeError for an unknown name,
/// with one that is close to it, and InputError for values. `function` is for messages.
alhazen::Settings settings_of(const std::string& function, const py::object& base, const py::dict& keywords);

void bind_settings(py::module_& m);

}  // namespace alhazen::python

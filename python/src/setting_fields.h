#pragma once

// The members of alhazen::Settings for Python: names, documentation, and conversions in both directions.

#include <functional>
#include <string>
#include <vector>

#include "alhazen/alhazen.h"
#include "bindings.h"

namespace alhazen::python {

struct SettingField {
  const char* name;
  const char* type;  ///< for documentation
  const char* help;
  std::function<py::object(const alhazen::Settings&)> get;
  /// None stands for the default. Throws InputError that names the setting.
  std::function<void(alhazen::Settings&, const py::handle&)> set;
  bool is_alias = false;  ///< another name or form of others, which `repr` leaves out
};

const std::vector<SettingField>& setting_fields();

}  // namespace alhazen::python

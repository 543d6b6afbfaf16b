#pragma once

// Modules: parts of the program in shared objects of their own, which are loaded when they are asked for and may be
// missing.

#include <string>

namespace alhazen {

struct Module {
  std::string path;                 ///< its file; empty where there is none
  const void* functions = nullptr;  ///< the table that it hands out; null where it cannot be used
  std::string problem;              ///< then: why, and what to do
};

/// Where modules are looked for: the folder that the environment variable ALHAZEN_MODULES names, else the folder
/// `alhazen` beside the library of this function.
std::string module_folder();

/// Loads the module `name` from `folder`. `how_to_get` ends a sentence for those who have not got it.
Module open_module(const std::string& folder, const std::string& name, const std::string& how_to_get);

/// Loads the module of `Table` from module_folder(), once. `Table::name` is the module's and `Table::how_to_get` as
/// above. The table is of the module's own headers, whose hash was compared.
template <class Table>
const Module& load_module() {
  static const Module module = open_module(module_folder(), Table::name, Table::how_to_get);
  return module;
}

template <class Table>
const Table& functions_of(const Module& module) {
  return *static_cast<const Table*>(module.functions);
}

}  // namespace alhazen

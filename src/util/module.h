#pragma once

// Modules are parts of the program in separate shared objects. They are loaded on demand and may be missing.

#include <string>

namespace alhazen::impl {

struct Module {
  std::string path;                 ///< its file; empty if there is none
  const void* functions = nullptr;  ///< the function table of the module; null if it cannot be used
  std::string problem;              ///< if it cannot be used: the reason, and what to do
};

/// Returns the folder of the modules: the value of the environment variable ALHAZEN_MODULES, else the folder `alhazen`
/// beside the library that contains this function.
std::string module_folder();

/// Loads the module `name` from `folder`. `how_to_get` completes the message for a missing module.
Module open_module(const std::string& folder, const std::string& name, const std::string& how_to_get);

/// Loads the module of `Table` from module_folder(), once. `Table::name` and `Table::how_to_get` are the arguments of
/// open_module(). A loaded module was built with the same definition of `Table`, since the hashes of the headers are
/// equal.
template <class Table>
const Module& load_module() {
  static const Module module = open_module(module_folder(), Table::name, Table::how_to_get);
  return module;
}

template <class Table>
const Table& functions_of(const Module& module) {
  return *static_cast<const Table*>(module.functions);
}

}  // namespace alhazen::impl

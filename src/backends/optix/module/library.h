#pragma once

// The library of OptiX, which comes with the driver and is looked for when the program runs.

#include <optix_types.h>

#include <optix_function_table.h>

#include <string>

namespace alhazen::optix {

struct OptixLibrary {
  OptixFunctionTable functions{};
  std::string problem;  ///< where it cannot be used: why, and what to do
};

/// Loaded once. `name` is there for tests.
OptixLibrary load_optix(const char* name = "libnvoptix.so.1");
const OptixLibrary& optix_library();

/// Throws RenderError unless `result` is a success. `doing` ends the sentence "OptiX failed while ..."; `log` is what
/// OptiX itself says.
void check(const OptixFunctionTable& functions, OptixResult result, const char* doing, const std::string& log = "");

}  // namespace alhazen::optix

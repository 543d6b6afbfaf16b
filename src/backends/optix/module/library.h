#pragma once

// The OptiX library, which is part of the NVIDIA driver and is loaded at run time.

#include <optix_types.h>

#include <optix_function_table.h>

#include <string>

namespace alhazen::impl::optix {

struct OptixLibrary {
  OptixFunctionTable functions{};
  std::string problem;  ///< if it cannot be used: the reason, and what to do
};

/// Loads the library, which only tests call by another name.
OptixLibrary load_optix(const char* name = "libnvoptix.so.1");
/// Returns the library, which is loaded once.
const OptixLibrary& optix_library();

/// Throws RenderError unless `result` is a success. `doing` completes the sentence "OptiX failed while ..."; `log`
/// holds the messages of OptiX.
void check(const OptixFunctionTable& functions, OptixResult result, const char* doing, const std::string& log = "");

}  // namespace alhazen::impl::optix

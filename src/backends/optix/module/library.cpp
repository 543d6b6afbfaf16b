#include "backends/optix/module/library.h"

#include <dlfcn.h>

#include "util/diagnostics.h"
#include "util/printable.h"

namespace alhazen::impl::optix {

namespace {

using QueryFunctionTable = OptixResult(int, unsigned, OptixQueryFunctionTableOptions*, const void**, void*, size_t);

std::string explain_query(OptixResult result) {
  if (result == OPTIX_ERROR_UNSUPPORTED_ABI_VERSION)
    return "the NVIDIA driver is too old for OptiX 9.0: install driver R570 or newer, or use the backend cuda";
  return "the driver's OptiX library refuses to start (error " + std::to_string(result) +
         "): reinstall the NVIDIA driver, or use the backend cuda";
}

}  // namespace

OptixLibrary load_optix(const char* name) {
  OptixLibrary library;
  void* handle = dlopen(name, RTLD_NOW);
  if (!handle) {
    library.problem = std::string(name) +
                      " is not here: install the ray tracing library of the NVIDIA driver (Debian: libnvoptix1; in a "
                      "container: the driver capability 'graphics'), or use the backend cuda";
    return library;
  }
  auto* query = reinterpret_cast<QueryFunctionTable*>(dlsym(handle, "optixQueryFunctionTable"));
  if (!query) {
    library.problem =
        std::string(name) + " is no library of OptiX: reinstall the NVIDIA driver, or use the backend cuda";
    return library;
  }
  const OptixResult result =
      query(OPTIX_ABI_VERSION, 0, nullptr, nullptr, &library.functions, sizeof(library.functions));
  if (result != OPTIX_SUCCESS) library.problem = explain_query(result);
  return library;
}

const OptixLibrary& optix_library() {
  static const OptixLibrary library = load_optix();
  return library;
}

void check(const OptixFunctionTable& functions, OptixResult result, const char* doing, const std::string& log) {
  if (result == OPTIX_SUCCESS) return;
  if (result == OPTIX_ERROR_DEVICE_OUT_OF_MEMORY || result == OPTIX_ERROR_HOST_OUT_OF_MEMORY)
    throw OutOfMemoryError(std::string("OptiX is out of memory while ") + doing +
                           ": render fewer pixels or layers at once (--size, --crop), or by another backend");
  const char* name = functions.optixGetErrorName ? functions.optixGetErrorName(result) : nullptr;
  throw DeviceError(printable_lines(std::string("OptiX failed while ") + doing + ": " +
                                    (name ? name : std::to_string(result)) + (log.empty() ? "" : ": " + log)));
}

}  // namespace alhazen::impl::optix

#pragma once

// The interface of the module `cuda`, which contains everything that needs the CUDA runtime.

#include "backends/cuda/device.h"

namespace alhazen::impl::cuda {

struct CudaModule {
  static constexpr const char* name = "cuda";
  static constexpr const char* how_to_get =
      "install the CUDA toolkit (nvcc), configure again and build the target alhazen_cuda";

  DeviceList (*query_devices)();
  std::unique_ptr<Engine> (*make_engine)(int device, const DeviceRows& rows, Precision precision);
};

}  // namespace alhazen::impl::cuda

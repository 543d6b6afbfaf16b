#pragma once

// The interface of the module `optix`, which contains everything that needs OptiX.

#include "backends/cuda/device.h"
#include "render/denoiser.h"

namespace alhazen::impl::optix {

struct OptixModule {
  static constexpr const char* name = "optix";
  static constexpr const char* how_to_get =
      "configure with -DOptiX_ROOT= set to the headers of OptiX 9.0, and with CUDA, and build the target alhazen_optix";

  /// Returns why the OptiX library of the driver cannot be used, or an empty string if it can.
  std::string (*problem)();
  /// Returns an engine that renders in float on GPU `device`.
  std::unique_ptr<cuda::Engine> (*make_engine)(int device, const cuda::DeviceRows& rows);
  std::vector<float> (*denoise)(const NoisyImage& image, int device);
};

}  // namespace alhazen::impl::optix

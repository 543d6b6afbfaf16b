#pragma once

// What the module `optix` hands out: OptiX on top of CUDA's runtime.

#include "backends/cuda/device.h"
#include "render/denoiser.h"

namespace alhazen::optix {

struct OptixModule {
  static constexpr const char* name = "optix";
  static constexpr const char* how_to_get =
      "configure with -DOptiX_ROOT= set to the headers of OptiX 9.0, and with CUDA, and build the target alhazen_optix";

  /// Why the driver's library of OptiX cannot be used here; empty where it can.
  std::string (*problem)();
  /// Rendering on GPU `device`, in float.
  std::unique_ptr<cuda::Engine> (*make_engine)(int device, const cuda::RowShare& share);
  std::vector<float> (*denoise)(const NoisyImage& image, int device);
};

}  // namespace alhazen::optix

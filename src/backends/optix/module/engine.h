#pragma once

#include <memory>

#include "backends/cuda/device.h"
#include "render/denoiser.h"

namespace alhazen::impl::optix {

/// Returns an engine that renders with OptiX on GPU `device`, in float.
std::unique_ptr<cuda::Engine> make_optix_engine(int device, const cuda::DeviceRows& rows);

std::vector<float> denoise(const NoisyImage& image, int device);

}  // namespace alhazen::impl::optix

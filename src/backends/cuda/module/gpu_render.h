#pragma once

// Renders on a GPU in one precision. The kernels of each precision are compiled in a file of their own.

#include <memory>

#include "backends/cuda/device.h"

namespace alhazen::impl::cuda {

template <class Real>
class GpuRender {
 public:
  virtual ~GpuRender() = default;
  virtual void render_pass(const RenderPass<Real>& pass, ThreadStatistics& statistics) = 0;
};

template <class Real>
std::unique_ptr<GpuRender<Real>> make_gpu_render(int device, const DeviceRows& rows);
template <>
std::unique_ptr<GpuRender<float>> make_gpu_render(int device, const DeviceRows& rows);
template <>
std::unique_ptr<GpuRender<double>> make_gpu_render(int device, const DeviceRows& rows);

}  // namespace alhazen::impl::cuda

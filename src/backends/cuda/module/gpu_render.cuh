#pragma once

// The implementation of GpuRender, which gpu_render_float.cu and gpu_render_double.cu instantiate.

#include "backends/cuda/device_render.h"
#include "backends/cuda/module/cuda_executor.cuh"
#include "backends/cuda/module/gpu_render.h"

namespace alhazen::impl::cuda {

template <RayTracing Tracing, class Real>
class CudaRender final : public GpuRender<Real> {
 public:
  CudaRender(int device, const DeviceRows& rows) : executor_(device), render_(executor_, rows) {}

  void render_pass(const RenderPass<Real>& pass, ThreadStatistics& statistics) override {
    executor_.use_device();
    render_.render_pass(pass, statistics);
  }

 private:
  CudaExecutor executor_;
  DeviceRender<CudaExecutor, Tracing, Real> render_;
};

}  // namespace alhazen::impl::cuda

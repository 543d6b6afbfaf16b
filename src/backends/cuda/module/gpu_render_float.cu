#include "backends/cuda/module/gpu_render.cuh"

namespace alhazen::impl::cuda {

template <>
std::unique_ptr<GpuRender<float>> make_gpu_render(int device, const DeviceRows& rows) {
  return std::make_unique<CudaRender<CwbvhTracing, float>>(device, rows);
}

}  // namespace alhazen::impl::cuda

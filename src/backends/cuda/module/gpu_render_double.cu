#include "backends/cuda/module/gpu_render.cuh"

namespace alhazen::impl::cuda {

template <>
std::unique_ptr<GpuRender<double>> make_gpu_render(int device, const DeviceRows& rows) {
  return std::make_unique<CudaRender<Bvh2Tracing, double>>(device, rows);
}

}  // namespace alhazen::impl::cuda

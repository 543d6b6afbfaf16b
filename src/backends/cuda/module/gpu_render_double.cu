#include "backends/cuda/module/gpu_render.cuh"

namespace alhazen::cuda {

template <>
std::unique_ptr<GpuRender<double>> make_gpu_render(int device, const RowShare& share) {
  return std::make_unique<CudaRender<Bvh2Tracing, double>>(device, share);
}

}  // namespace alhazen::cuda

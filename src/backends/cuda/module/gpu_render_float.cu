#include "backends/cuda/module/gpu_render.cuh"

namespace alhazen::cuda {

template <>
std::unique_ptr<GpuRender<float>> make_gpu_render(int device, const RowShare& share) {
  return std::make_unique<CudaRender<CwbvhTracing, float>>(device, share);
}

}  // namespace alhazen::cuda

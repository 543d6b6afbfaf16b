#include "backends/cuda/device_render.h"
#include "backends/cuda/module/cuda_executor.cuh"
#include "backends/optix/module/denoiser.h"
#include "backends/optix/module/engine.h"
#include "backends/optix/module/executor.h"

namespace alhazen::impl::optix {

namespace {

class OptixEngine final : public cuda::Engine {
 public:
  OptixEngine(int device, const cuda::DeviceRows& rows)
      : executor_(optix_library().functions, device_code(), device), render_(executor_, rows) {}

  void prepare(const CompiledScene<float>& scene) override {
    executor_.use_device();
    render_.prepare(scene);
  }
  void render_pass(const RenderPass<float>& pass, ThreadStatistics& statistics) override {
    executor_.use_device();
    render_.render_pass(pass, statistics);
  }
  void render_pass(const RenderPass<double>&, ThreadStatistics&) override {
    throw InputError("the backend 'optix' traces rays in float: use --precision float, or the backend cuda");
  }

 private:
  using Executor = OptixExecutor<cuda::CudaExecutor>;
  Executor executor_;
  cuda::DeviceRender<Executor, OptixTracing, float> render_;
};

}  // namespace

std::unique_ptr<cuda::Engine> make_optix_engine(int device, const cuda::DeviceRows& rows) {
  return std::make_unique<OptixEngine>(device, rows);
}

std::vector<float> denoise(const NoisyImage& image, int device) {
  cuda::CudaExecutor executor(device);
  const Context context(optix_library().functions);
  return Denoiser(optix_library().functions, context, executor).denoise(image);
}

}  // namespace alhazen::impl::optix

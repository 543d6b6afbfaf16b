#include "backends/cuda/module.h"

#include "backends/cuda/module/cuda_error.h"
#include "backends/cuda/module/gpu_render.h"
#include "util/define_module.h"

namespace alhazen::impl::cuda {

namespace {

/// Lists the GPUs that the CUDA runtime finds, or explains why there are none.
DeviceList query_devices() {
  DeviceList list;
  int count = 0;
  const cudaError_t error = cudaGetDeviceCount(&count);
  if (error != cudaSuccess || count == 0) {
    list.problem = explain_no_device(error == cudaSuccess ? cudaErrorNoDevice : error);
    return list;
  }
  for (int i = 0; i < count; ++i) {
    cudaDeviceProp properties{};
    check(cudaGetDeviceProperties(&properties, i), "querying its properties");
    list.devices.push_back({properties.name, properties.major, properties.minor, properties.totalGlobalMem,
                            properties.multiProcessorCount});
  }
  return list;
}

/// Renders on a GPU in the precision that is passed to the constructor.
class GpuEngine final : public Engine {
 public:
  GpuEngine(int device, const DeviceRows& rows, Precision precision) {
    if (precision == Precision::single)
      single_ = make_gpu_render<float>(device, rows);
    else
      double_ = make_gpu_render<double>(device, rows);
  }

  void render_pass(const RenderPass<float>& pass, ThreadStatistics& statistics) override {
    single_->render_pass(pass, statistics);
  }
  void render_pass(const RenderPass<double>& pass, ThreadStatistics& statistics) override {
    double_->render_pass(pass, statistics);
  }

 private:
  std::unique_ptr<GpuRender<float>> single_;
  std::unique_ptr<GpuRender<double>> double_;
};

std::unique_ptr<Engine> make_engine(int device, const DeviceRows& rows, Precision precision) {
  return std::make_unique<GpuEngine>(device, rows, precision);
}

const CudaModule table{query_devices, make_engine};

}  // namespace

}  // namespace alhazen::impl::cuda

ALHAZEN_MODULE("cuda", alhazen::impl::cuda::table)

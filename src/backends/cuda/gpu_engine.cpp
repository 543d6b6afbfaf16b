// The engine of a GPU: made in the precision that is asked for.

#ifdef ALHAZEN_WITH_CUDA

#include "backends/cuda/gpu_render.h"

namespace alhazen::cuda {

namespace {

class GpuEngine final : public Engine {
 public:
  GpuEngine(int device, const RowShare& share, Precision precision) {
    if (precision == Precision::single)
      single_ = make_gpu_render<float>(device, share);
    else
      double_ = make_gpu_render<double>(device, share);
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

}  // namespace

std::unique_ptr<Engine> make_gpu_engine(int device, const RowShare& share, Precision precision) {
  return std::make_unique<GpuEngine>(device, share, precision);
}

}  // namespace alhazen::cuda

#endif

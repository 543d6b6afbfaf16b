// The engine of a GPU: made in the precision that is asked for.

#ifdef ALHAZEN_WITH_CUDA

#include "backends/cuda/gpu_render.h"

namespace alhazen::cuda {

namespace {

class GpuEngine final : public Engine {
 public:
  GpuEngine(int device, const RowShare& share) : device_(device), share_(share) {}

  void render_pass(const RenderPass<float>& pass, ThreadStatistics& statistics) override {
    if (!single_) single_ = make_gpu_render<float>(device_, share_);
    single_->render_pass(pass, statistics);
  }
  void render_pass(const RenderPass<double>& pass, ThreadStatistics& statistics) override {
    if (!double_) double_ = make_gpu_render<double>(device_, share_);
    double_->render_pass(pass, statistics);
  }

 private:
  int device_;
  RowShare share_;
  std::unique_ptr<GpuRender<float>> single_;
  std::unique_ptr<GpuRender<double>> double_;
};

}  // namespace

std::unique_ptr<Engine> make_gpu_engine(int device, const RowShare& share) {
  return std::make_unique<GpuEngine>(device, share);
}

}  // namespace alhazen::cuda

#endif

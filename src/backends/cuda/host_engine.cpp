// The CPU-emulated kernels: `--backend cuda --device host`.

#include "backends/cuda/device.h"
#include "backends/cuda/device_render.h"
#include "backends/cuda/host_executor.h"

namespace alhazen::impl::cuda {

namespace {

class HostEngine final : public Engine {
 public:
  explicit HostEngine(const DeviceRows& rows) : single_(executor_, rows), double_(executor_, rows) {}

  void render_pass(const RenderPass<float>& pass, ThreadStatistics& statistics) override {
    single_.render_pass(pass, statistics);
  }
  void render_pass(const RenderPass<double>& pass, ThreadStatistics& statistics) override {
    double_.render_pass(pass, statistics);
  }

 private:
  HostExecutor executor_;
  DeviceRender<HostExecutor, Bvh2Tracing, float> single_;
  DeviceRender<HostExecutor, Bvh2Tracing, double> double_;
};

}  // namespace

std::unique_ptr<Engine> make_host_engine(const DeviceRows& rows) { return std::make_unique<HostEngine>(rows); }

}  // namespace alhazen::impl::cuda

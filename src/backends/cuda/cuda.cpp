// The backend `cuda`: picks devices and has each render its share of the rows.

#include <exception>
#include <mutex>
#include <thread>

#include "backends/cuda/device.h"
#include "backends/pixel_blocks.h"

namespace alhazen {

namespace {

using namespace cuda;

std::string describe_device(const DeviceInfo& d) {
  char text[64];
  std::snprintf(text, sizeof(text), ", compute capability %d.%d, %.1f GiB, %d SMs", d.major, d.minor,
                static_cast<double>(d.memory) / (1 << 30), d.multiprocessors);
  return d.name + text;
}

class CudaBackend final : public Backend {
 public:
  BackendDescription describe() const override {
    const DeviceList& list = list_devices();
    BackendDescription description{
        "cuda", {"persistent", "pixel", "chunk", "wavefront"}, !list.devices.empty(), list.problem, {}};
    for (const DeviceInfo& device : list.devices) description.devices.push_back(describe_device(device));
    if (description.available)
      description.details =
          std::to_string(list.devices.size()) + (list.devices.size() == 1 ? " GPU" : " GPUs, --device N or all");
    return description;
  }

  void start(const RenderSettings& settings) override {
    if (settings.device == host_device) {
      engines_.push_back(make_host_engine({}));
      return;
    }
    if (settings.device != all_devices) {
      engines_.push_back(make_gpu_engine(settings.device, {}, settings.precision));
      return;
    }
    const uint32_t count = static_cast<uint32_t>(list_devices().devices.size());
    for (uint32_t i = 0; i < count; ++i)
      engines_.push_back(make_gpu_engine(static_cast<int>(i), {i, count}, settings.precision));
  }

  /// A GPU takes many samples in the time that a pass costs it, and looks for an end of the render between slices.
  uint32_t most_samples_per_pass() const override { return 1024; }

  void render_pass(const RenderPass<float>& pass) override { render(pass); }
  void render_pass(const RenderPass<double>& pass) override { render(pass); }

 private:
  template <class Real>
  void render(const RenderPass<Real>& pass) {
    if (engines_.size() == 1) {
      const BusyTimer timer(pass.control.thread(0));
      engines_[0]->render_pass(pass, pass.control.thread(0));
      return;
    }
    std::exception_ptr failure;
    std::mutex mutex;
    std::vector<std::thread> threads;
    for (size_t i = 0; i < engines_.size(); ++i)
      threads.emplace_back([&, i] {
        ThreadStatistics& statistics = pass.control.thread(static_cast<int>(i));
        const BusyTimer timer(statistics);
        try {
          engines_[i]->render_pass(pass, statistics);
        } catch (...) {
          const std::lock_guard lock(mutex);
          failure = std::current_exception();
          pass.control.stop();
        }
      });
    for (std::thread& thread : threads) thread.join();
    if (failure) std::rethrow_exception(failure);
  }

  std::vector<std::unique_ptr<Engine>> engines_;
};

}  // namespace

std::unique_ptr<Backend> make_cuda_backend() { return std::make_unique<CudaBackend>(); }

}  // namespace alhazen

// The backend `cuda` runs our own kernels on GPUs.

#include "backends/cuda/blocks.h"
#include "backends/cuda/device_backend.h"
#include "backends/cuda/module.h"
#include "backends/cuda/strategy.h"
#include "util/module.h"

namespace alhazen::impl {

namespace {

using namespace cuda;

class CudaBackend final : public DeviceBackend {
 public:
  BackendTraits traits() const override {
    BackendTraits traits{"cuda", {"persistent", "pixel", "chunk", "wavefront"}, "NVIDIA GPUs, or --device host"};
    traits.runs_on_devices = traits.runs_on_host = true;
    return traits;
  }

  BackendStatus status() const override {
    const DeviceList& list = list_devices();
    BackendStatus status{!list.devices.empty(), list.problem, describe_devices(), load_module<CudaModule>().path};
    if (status.available)
      status.details =
          std::to_string(list.devices.size()) + (list.devices.size() == 1 ? " GPU" : " GPUs, --device N or all");
    return status;
  }

  std::vector<NamedSetting> named_settings(const RenderSettings& settings) const override {
    std::vector<NamedSetting> named = DeviceBackend::named_settings(settings);
    named.emplace_back("block", to_string(settings.block));
    named.emplace_back("chunk", to_string(settings.chunk));
    return named;
  }

  BvhLayouts wanted_layouts(const RenderSettings& settings) const override {
    BvhLayouts layouts{BvhLayout::bvh2};
    if (settings.device != host_device) layouts.add(BvhLayout::cwbvh);
    return layouts;
  }

 protected:
  void configure_blocks(const Settings& asked, RenderSettings& settings) const override {
    const auto strategy = static_cast<CudaStrategy>(settings.strategy);
    if (!asked.block.empty()) {
      if (strategy != CudaStrategy::pixel && strategy != CudaStrategy::chunk)
        throw InputError("a block size is for the strategies pixel and chunk of the backend cuda");
      settings.block = parse_block(asked.block);
    }
    if (!asked.chunk.empty()) {
      if (strategy != CudaStrategy::chunk)
        throw InputError("a number of chunks is for the strategy chunk of the backend cuda");
      settings.chunk = parse_chunks(asked.chunk);
    }
  }

  std::unique_ptr<Engine> make_engine(int device, const DeviceRows& rows, Precision precision) override {
    return device == host_device ? make_host_engine(rows) : make_gpu_engine(device, rows, precision);
  }
};

}  // namespace

std::unique_ptr<Backend> make_cuda_backend() { return std::make_unique<CudaBackend>(); }

}  // namespace alhazen::impl

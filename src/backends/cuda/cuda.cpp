// The backend `cuda`: our own kernels on GPUs.

#include "backends/cuda/device_backend.h"

namespace alhazen {

namespace {

using namespace cuda;

class CudaBackend final : public DeviceBackend {
 public:
  BackendDescription describe() const override {
    const DeviceList& list = list_devices();
    BackendDescription description{
        "cuda", {"persistent", "pixel", "chunk", "wavefront"}, !list.devices.empty(), list.problem, describe_devices()};
    description.runs_on_devices = description.runs_on_host = true;
    if (description.available)
      description.details =
          std::to_string(list.devices.size()) + (list.devices.size() == 1 ? " GPU" : " GPUs, --device N or all");
    return description;
  }

  BvhLayouts wanted_layouts(const RenderSettings& settings) const override {
    BvhLayouts layouts{BvhLayout::bvh2};
    if (settings.device != host_device) layouts.add(BvhLayout::cwbvh);
    return layouts;
  }

 protected:
  std::unique_ptr<Engine> make_engine(int device, const RowShare& share, Precision precision) override {
    return device == host_device ? make_host_engine(share) : make_gpu_engine(device, share, precision);
  }
};

}  // namespace

std::unique_ptr<Backend> make_cuda_backend() { return std::make_unique<CudaBackend>(); }

}  // namespace alhazen

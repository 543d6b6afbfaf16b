// Uses GPUs through the module `cuda`.

#include "backends/cuda/device.h"
#include "backends/cuda/module.h"
#include "util/module.h"

namespace alhazen::impl::cuda {

const DeviceList& list_devices() {
  static const DeviceList list = [] {
    const Module& module = load_module<CudaModule>();
    return module.functions ? functions_of<CudaModule>(module).query_devices() : DeviceList{{}, module.problem};
  }();
  return list;
}

std::unique_ptr<Engine> make_gpu_engine(int device, const DeviceRows& rows, Precision precision) {
  const Module& module = load_module<CudaModule>();
  if (!module.functions) throw UnsupportedError(module.problem);
  return functions_of<CudaModule>(module).make_engine(device, rows, precision);
}

}  // namespace alhazen::impl::cuda

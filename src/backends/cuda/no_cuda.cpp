// What stands in the place of the GPU where the binary was built without nvcc.

#ifndef ALHAZEN_WITH_CUDA

#include "backends/cuda/device.h"

namespace alhazen::cuda {

const DeviceList& list_devices() {
  static const DeviceList none{
      {}, "this binary was built without CUDA: install the CUDA toolkit (nvcc) and configure again"};
  return none;
}

std::unique_ptr<Engine> make_gpu_engine(int, const RowShare&, Precision) { throw InputError(list_devices().problem); }

}  // namespace alhazen::cuda

#endif

// The fuzz targets render with the serial backend. This stub replaces the CPU-emulated GPU kernels, which take long to
// compile.

#include "backends/cuda/device.h"

namespace alhazen::impl::cuda {

std::unique_ptr<Engine> make_host_engine(const DeviceRows&) {
  throw InputError("the fuzz targets are built without the kernels of GPUs");
}

}  // namespace alhazen::impl::cuda

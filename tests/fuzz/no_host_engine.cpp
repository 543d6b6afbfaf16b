// The fuzz targets render by the serial backend; the CPU-emulated GPU kernels take long to compile.

#include "backends/cuda/device.h"

namespace alhazen::cuda {

std::unique_ptr<Engine> make_host_engine(const RowShare&) {
  throw InputError("the fuzz targets are built without the kernels of GPUs");
}

}  // namespace alhazen::cuda

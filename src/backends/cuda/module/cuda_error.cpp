#include "backends/cuda/module/cuda_error.h"

#include "util/diagnostics.h"

namespace alhazen::impl::cuda {

namespace {

std::string version_text(int version) {
  return std::to_string(version / 1000) + "." + std::to_string(version % 1000 / 10);
}

}  // namespace

std::string explain_no_device(cudaError_t error) {
  int driver = 0;
  if (cudaDriverGetVersion(&driver) != cudaSuccess || driver == 0)
    return "there is no NVIDIA driver here: install one, or use another backend";
  switch (error) {
    case cudaErrorNoDevice:
      return "the NVIDIA driver finds no GPU: look at nvidia-smi and at CUDA_VISIBLE_DEVICES, or use another backend";
    case cudaErrorInsufficientDriver: {
      int runtime = 0;
      cudaRuntimeGetVersion(&runtime);
      return "the NVIDIA driver is too old: it knows CUDA " + version_text(driver) + ", and this binary needs " +
             version_text(runtime) + ": update the driver, or build with an older CUDA toolkit";
    }
    default:
      return std::string("the GPU cannot be used: ") + cudaGetErrorString(error) +
             ": look at nvidia-smi, or use another backend";
  }
}

void check(cudaError_t result, const char* doing) {
  if (result == cudaSuccess) return;
  cudaGetLastError();  // clears the error, which a later call would report again
  const std::string where = std::string("while ") + doing;
  switch (result) {
    case cudaErrorMemoryAllocation:
      throw OutOfMemoryError("the GPU is out of memory " + where +
                             ": render fewer pixels or layers at once (--size, --crop), in float, or by a CPU backend");
    case cudaErrorNoKernelImageForDevice:
    case cudaErrorInvalidDeviceFunction:
    case cudaErrorUnsupportedPtxVersion:
      throw UnsupportedError(
          "this binary contains no code for this GPU: build it with ALHAZEN_CUDA_ARCHITECTURES set to the "
          "GPU's compute capability, which 'alhazen devices' prints, or update the driver");
    case cudaErrorNoDevice:
    case cudaErrorInsufficientDriver:
    case cudaErrorSystemDriverMismatch:
      throw UnsupportedError(explain_no_device(result));
    case cudaErrorLaunchTimeout:
      throw DeviceError("the GPU was stopped " + where +
                        " because it took too long: it drives a display; use another GPU, or the strategy wavefront, "
                        "whose launches are short");
    default:
      throw DeviceError("the GPU failed " + where + ": " + cudaGetErrorString(result));
  }
}

}  // namespace alhazen::impl::cuda

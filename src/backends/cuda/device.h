#pragma once

// Devices as the backend sees them: what there is, and an engine that renders on one of them.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "backends/cuda/kernels/launch.h"
#include "render/backend.h"

namespace alhazen::cuda {

/// Renders its share of the rows of every pass on one device.
class Engine {
 public:
  virtual ~Engine() = default;
  /// As Backend::prepare.
  virtual void prepare(const CompiledScene<float>&) {}
  virtual void render_pass(const RenderPass<float>& pass, ThreadStatistics& statistics) = 0;
  virtual void render_pass(const RenderPass<double>& pass, ThreadStatistics& statistics) = 0;
};

/// The kernels on the host.
std::unique_ptr<Engine> make_host_engine(const RowShare& share);

struct DeviceInfo {
  std::string name;
  int major = 0, minor = 0;  ///< compute capability
  uint64_t memory = 0;       ///< bytes
  int multiprocessors = 0;
};

struct DeviceList {
  std::vector<DeviceInfo> devices;
  std::string problem;  ///< where there are none: why, and what to do
};

/// The GPUs of this machine. Without the module `cuda`: none, and how to get it.
const DeviceList& list_devices();

/// The kernels on GPU `device`, for passes in that precision alone. Starts the GPU.
std::unique_ptr<Engine> make_gpu_engine(int device, const RowShare& share, Precision precision);

}  // namespace alhazen::cuda

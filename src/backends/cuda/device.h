#pragma once

// The devices that the backend can use, and the engine that renders on one of them.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "backends/cuda/kernels/launch.h"
#include "render/backend.h"

namespace alhazen::impl::cuda {

/// Renders the rows of every pass that are assigned to one device (DeviceRows).
class Engine {
 public:
  virtual ~Engine() = default;
  /// See Backend::prepare.
  virtual void prepare(const CompiledScene<float>&) {}
  virtual void render_pass(const RenderPass<float>& pass, ThreadStatistics& statistics) = 0;
  virtual void render_pass(const RenderPass<double>& pass, ThreadStatistics& statistics) = 0;
};

/// Returns an engine with the CPU-emulated kernels.
std::unique_ptr<Engine> make_host_engine(const DeviceRows& rows);

struct DeviceInfo {
  std::string name;
  int major = 0, minor = 0;  ///< compute capability
  uint64_t memory = 0;       ///< bytes
  int multiprocessors = 0;
};

struct DeviceList {
  std::vector<DeviceInfo> devices;
  std::string problem;  ///< if there are none: the reason, and what to do
};

/// Returns the GPUs of this machine. Without the module `cuda` there are none, and `problem` says how to get it.
const DeviceList& list_devices();

/// Returns an engine that renders passes in `precision` on GPU `device`, and initializes the GPU. Throws InputError if
/// the module `cuda` cannot be loaded.
std::unique_ptr<Engine> make_gpu_engine(int device, const DeviceRows& rows, Precision precision);

}  // namespace alhazen::impl::cuda

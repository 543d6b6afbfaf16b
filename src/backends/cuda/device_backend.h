#pragma once

// What backends of GPUs have in common: an engine a device, each with its share of the rows, on threads of their own.

#include "backends/cuda/device.h"

namespace alhazen::cuda {

class DeviceBackend : public Backend {
 public:
  void start(const RenderSettings& settings) override;
  void prepare(const CompiledScene<float>& scene) override;
  /// A GPU takes many samples in the time that a pass costs it, and looks for an end of the render between slices.
  uint32_t most_samples_per_pass() const override { return 1024; }
  void render_pass(const RenderPass<float>& pass) override;
  void render_pass(const RenderPass<double>& pass) override;

 protected:
  /// An engine for one of the devices of describe(), or for the host.
  virtual std::unique_ptr<Engine> make_engine(int device, const RowShare& share, Precision precision) = 0;

 private:
  template <class Real>
  void render(const RenderPass<Real>& pass);
  /// Calls action(engine, index) for every engine at the same time.
  template <class Action>
  void on_every_engine(const Action& action);

  std::vector<std::unique_ptr<Engine>> engines_;
};

/// The GPUs of this machine, one a line.
std::vector<std::string> describe_devices();

}  // namespace alhazen::cuda

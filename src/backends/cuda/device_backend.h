#pragma once

// What backends of GPUs have in common: an engine a device, each with its share of the rows, on threads of their own.

#include "backends/cuda/device.h"

namespace alhazen::cuda {

class DeviceBackend : public Backend {
 public:
  void configure(const Settings& asked, RenderSettings& settings) const override;
  std::vector<NamedSetting> named_settings(const RenderSettings& settings) const override;
  void start(const RenderSettings& settings) override;
  void prepare(const CompiledScene<float>& scene) override;
  /// A GPU takes many samples in the time that a pass costs it, and looks for an end of the render between slices.
  uint32_t max_samples_per_pass() const override { return 1024; }
  void render_pass(const RenderPass<float>& pass) override;
  void render_pass(const RenderPass<double>& pass) override;

 protected:
  /// What else of `asked` is its own; by default it takes no blocks.
  virtual void configure_blocks(const Settings& asked, RenderSettings&) const { refuse_blocks(asked); }
  /// An engine for one of the devices of status(), or for the host.
  virtual std::unique_ptr<Engine> make_engine(int device, const RowShare& share, Precision precision) = 0;

 private:
  /// The device called `text`. Throws InputError.
  int parse_device(const std::string& text) const;
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

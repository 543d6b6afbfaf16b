#pragma once

// The base class of GPU backends. It has one engine per device, and each engine renders its rows on a thread of its
// own.

#include "backends/cuda/device.h"

namespace alhazen::impl::cuda {

class DeviceBackend : public Backend {
 public:
  void configure(const Settings& asked, RenderSettings& settings) const override;
  std::vector<NamedSetting> named_settings(const RenderSettings& settings) const override;
  void start(const RenderSettings& settings) override;
  void prepare(const CompiledScene<float>& scene) override;
  /// Large passes make the fixed cost of a pass negligible. Renders can be stopped between the slices of a pass.
  uint32_t max_samples_per_pass() const override { return 1024; }
  void render_pass(const RenderPass<float>& pass) override;
  void render_pass(const RenderPass<double>& pass) override;

 protected:
  /// Sets what only this backend supports. By default, block sizes and numbers of chunks are refused.
  virtual void configure_blocks(const Settings& asked, RenderSettings&) const { refuse_blocks(asked); }
  /// Returns an engine for one of the devices of status(), or for the host.
  virtual std::unique_ptr<Engine> make_engine(int device, const DeviceRows& rows, Precision precision) = 0;

 private:
  /// Returns the number of the device called `text`. Throws InputError.
  int parse_device(const std::string& text) const;
  template <class Real>
  void render(const RenderPass<Real>& pass);
  /// Calls action(engine, index) for all engines in parallel.
  template <class Action>
  void on_every_engine(const Action& action);

  std::vector<std::unique_ptr<Engine>> engines_;
};

/// Returns one line of text per GPU of this machine.
std::vector<std::string> describe_devices();

}  // namespace alhazen::impl::cuda

// The backend `optix`, which renders with the same core but traces rays with OptiX, and the denoiser `optix`.

#include "backends/optix/module.h"

#include "backends/cuda/device_backend.h"
#include "render/denoiser.h"
#include "util/module.h"

namespace alhazen::impl {

namespace {

using optix::OptixModule;

/// Returns why OptiX cannot be used here, or an empty string if it can. The module `cuda` lists the GPUs.
std::string problem() {
  const Module& module = load_module<OptixModule>();
  if (!module.functions) return module.problem;
  if (cuda::list_devices().devices.empty()) return cuda::list_devices().problem;
  return functions_of<OptixModule>(module).problem();
}

const OptixModule& functions() {
  const Module& module = load_module<OptixModule>();
  if (!module.functions) throw UnsupportedError(module.problem);
  return functions_of<OptixModule>(module);
}

class OptixBackend final : public cuda::DeviceBackend {
 public:
  BackendTraits traits() const override {
    BackendTraits traits{"optix", {"megakernel"}, "NVIDIA GPUs, rays traced by OptiX, in float"};
    traits.runs_on_devices = true;
    traits.traces_double = false;
    return traits;
  }

  BackendStatus status() const override {
    const std::string reason = problem();
    const std::string& path = load_module<OptixModule>().path;
    if (!reason.empty()) return {false, reason, {}, path};
    return {true, "OptiX 9.0, in float", cuda::describe_devices(), path};
  }

  BvhLayouts wanted_layouts(const RenderSettings&) const override { return {}; }

 protected:
  std::unique_ptr<cuda::Engine> make_engine(int device, const cuda::DeviceRows& rows, Precision) override {
    return functions().make_engine(device, rows);
  }
};

class OptixDenoiser final : public Denoiser {
 public:
  std::string name() const override { return "optix"; }
  std::string details() const override { return "NVIDIA's denoiser of OptiX 9.0, on a GPU"; }
  std::string problem() const override { return impl::problem(); }
  std::vector<float> denoise(const NoisyImage& image, const DenoiseOptions& options) const override {
    return functions().denoise(image, options.device);
  }
};

}  // namespace

std::unique_ptr<Backend> make_optix_backend() { return std::make_unique<OptixBackend>(); }
std::unique_ptr<Denoiser> make_optix_denoiser() { return std::make_unique<OptixDenoiser>(); }

}  // namespace alhazen::impl

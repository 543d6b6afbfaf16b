// The backend `optix`: the same core, with rays traced by the vendor's library.

#include "backends/cuda/device_backend.h"
#include "render/denoiser.h"

#ifdef ALHAZEN_WITH_OPTIX
#include "backends/optix/engine.h"
#include "backends/optix/library.h"
#endif

namespace alhazen {

namespace {

/// Why it cannot be used here; empty where it can.
std::string problem() {
#ifdef ALHAZEN_WITH_OPTIX
  if (cuda::list_devices().devices.empty()) return cuda::list_devices().problem;
  return optix::optix_library().problem;
#else
  return "this binary was built without OptiX: configure with -DOptiX_ROOT= set to its headers (9.0), and with CUDA";
#endif
}

class OptixBackend final : public cuda::DeviceBackend {
 public:
  BackendDescription describe() const override {
    const std::string reason = problem();
    BackendDescription description{"optix", {"megakernel"}, reason.empty(), reason, {}};
    description.runs_on_devices = true;
    description.traces_double = false;
    if (description.available) {
      description.devices = cuda::describe_devices();
      description.details = "OptiX 9.0, in float";
    }
    return description;
  }

 protected:
  std::unique_ptr<cuda::Engine> make_engine([[maybe_unused]] int device, [[maybe_unused]] const cuda::RowShare& share,
                                            Precision) override {
#ifdef ALHAZEN_WITH_OPTIX
    return optix::make_optix_engine(device, share);
#else
    throw InputError(problem());
#endif
  }
};

}  // namespace

std::string optix_denoiser_problem() { return problem(); }

std::vector<float> denoise_by_optix([[maybe_unused]] const NoisyPicture& picture, [[maybe_unused]] int device) {
#ifdef ALHAZEN_WITH_OPTIX
  return optix::denoise(picture, device);
#else
  throw InputError(problem());
#endif
}

std::unique_ptr<Backend> make_optix_backend() { return std::make_unique<OptixBackend>(); }

}  // namespace alhazen

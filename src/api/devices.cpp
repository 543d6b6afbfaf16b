#include "alhazen/devices.h"

#include <algorithm>
#include <thread>

#include "render/backend.h"
#include "render/denoiser.h"
#include "render/sample_kernel.h"
#include "study/machine.h"

namespace ALHAZEN_NAMESPACE {

Devices devices() {
  Devices all;
  for (const auto& backend : impl::all_backends()) {
    const impl::BackendTraits traits = backend->traits();
    const impl::BackendStatus status = backend->status();
    all.backends.push_back(
        {traits.name, status.available, status.details, status.devices, traits.strategies, status.module});
  }
  for (const auto& denoiser : impl::all_denoisers()) {
    const std::string problem = denoiser->problem();
    all.denoisers.push_back({denoiser->name(), problem.empty(), problem.empty() ? denoiser->details() : problem});
  }
  all.processor = impl::study::processor_name();
  all.processors = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  for (const impl::InstructionSet set : impl::built_instruction_sets())
    all.instruction_sets.push_back(impl::to_string(set));
  return all;
}

}  // namespace ALHAZEN_NAMESPACE

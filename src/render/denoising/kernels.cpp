#include "render/denoising/kernels.h"

#include "render/sample_kernel.h"

namespace alhazen::impl {

ALHAZEN_DECLARE_KERNEL(denoising::Kernels denoising_kernels())

namespace denoising {

std::vector<Kernels> all_kernels() {
  std::vector<Kernels> kernels;
  for (const InstructionSet set : instruction_sets()) kernels.push_back(ALHAZEN_KERNEL_OF(set, denoising_kernels)());
  return kernels;
}

}  // namespace denoising

}  // namespace alhazen::impl

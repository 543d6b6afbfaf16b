#include "render/denoising/kernels.h"

#include "render/sample_kernel.h"

namespace alhazen {

ALHAZEN_DECLARE_KERNEL(denoising::Kernels denoising_kernels())

namespace denoising {

Kernels select_kernels() { return ALHAZEN_KERNEL_OF(instruction_sets().back(), denoising_kernels)(); }

}  // namespace denoising

}  // namespace alhazen

// Compiled once per instruction set, in its namespace.

#include "render/kernels/kernel_templates.h"

namespace ALHAZEN_CORE {

RawKernel select_float_kernel(uint32_t integrator, uint32_t sampler) {
  return select_kernel<Bvh8Intersector<float>, float>(static_cast<IntegratorKind>(integrator),
                                                      static_cast<SamplerType>(sampler));
}

}  // namespace ALHAZEN_CORE

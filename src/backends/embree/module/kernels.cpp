// The sample kernels that trace with Embree, compiled once per instruction set, in its namespace, like those in
// render/kernels.

#include "backends/embree/module/intersector.h"
#include "render/kernels/kernel_templates.h"

namespace ALHAZEN_CORE {

RawKernel select_embree_kernel(uint32_t integrator, uint32_t sampler) {
  return select_kernel<SequentialBatches<float, EmbreeIntersector>, float>(static_cast<IntegratorKind>(integrator),
                                                                           static_cast<SamplerType>(sampler));
}

}  // namespace ALHAZEN_CORE

// The sample kernels of the fuzz targets: only those of the default integrator and sampler, which execute most of the
// core. Each of the others would take as long to compile.

#include "render/kernels/kernel_templates.h"

namespace ALHAZEN_CORE {

RawKernel select_float_kernel(uint32_t, uint32_t) {
  return take_blocks<IntegratorKind::path, SobolSampler, Bvh8Intersector<float>, float>;
}

RawKernel select_double_kernel(uint32_t, uint32_t) {
  return take_blocks<IntegratorKind::path, SobolSampler, Bvh8Intersector<double>, double>;
}

}  // namespace ALHAZEN_CORE

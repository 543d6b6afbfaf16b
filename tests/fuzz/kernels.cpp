// The sample kernels of the fuzz targets: of all integrators and samplers the default ones, which go through most of
// the core. The others take as long to compile, each.

#include "render/kernels/instances.h"

namespace ALHAZEN_CORE {

RawKernel select_float_kernel(uint32_t, uint32_t) {
  return take_blocks<IntegratorKind::path, SobolSampler, SimdBvhIntersector<float>, float>;
}

RawKernel select_double_kernel(uint32_t, uint32_t) {
  return take_blocks<IntegratorKind::path, SobolSampler, SimdBvhIntersector<double>, double>;
}

}  // namespace ALHAZEN_CORE

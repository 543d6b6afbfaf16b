#include "render/sample_kernel_instances.h"

namespace alhazen {

template <>
SampleKernel<float> select_sample_kernel(IntegratorKind integrator, SamplerType sampler) {
  return select_kernel<SimdBvhIntersector<float>, float>(integrator, sampler);
}

}  // namespace alhazen

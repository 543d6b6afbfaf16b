#include "render/sample_kernel_instances.h"

namespace alhazen {

template <>
SampleKernel<double> select_sample_kernel(IntegratorKind integrator, SamplerType sampler) {
  return select_kernel<SimdBvhIntersector<double>, double>(integrator, sampler);
}

}  // namespace alhazen

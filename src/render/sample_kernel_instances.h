#pragma once

// The body of the sample kernels, for the two files that instantiate it.

#include "core/bvh/simd_traversal.h"
#include "core/sampling/independent.h"
#include "core/sampling/sobol.h"
#include "render/sample_kernel.h"

namespace alhazen {

/// Sums samples of one pixel. `Intersector` is made from the scene and answers the ray queries.
template <IntegratorKind kind, class Sampler, class Intersector, class Real>
BlockSum<Real> sample_block(const SceneView<Real>& scene, uint32_t seed, uint32_t max_segments, uint32_t x, uint32_t y,
                            uint32_t first, uint32_t count) {
  const Intersector intersector(scene);
  BlockSum<Real> sum;
  for (uint32_t i = 0; i < count; ++i) {
    const Sampler sampler(seed, x, y, first + i);
    const CameraSample<Real> camera = sample_camera(scene, sampler, x, y);
    sum.add(integrate<kind>(scene, intersector, sampler, camera.ray, max_segments), camera.filter_weight);
  }
  return sum;
}

template <class Sampler, class Intersector, class Real>
SampleKernel<Real> select_by_integrator(IntegratorKind integrator) {
  switch (integrator) {
    case IntegratorKind::branching:
      return sample_block<IntegratorKind::branching, Sampler, Intersector, Real>;
    case IntegratorKind::recursive:
      return sample_block<IntegratorKind::recursive, Sampler, Intersector, Real>;
    case IntegratorKind::iterative:
      return sample_block<IntegratorKind::iterative, Sampler, Intersector, Real>;
    case IntegratorKind::path:
      break;
  }
  return sample_block<IntegratorKind::path, Sampler, Intersector, Real>;
}

template <class Intersector, class Real>
SampleKernel<Real> select_kernel(IntegratorKind integrator, SamplerType sampler) {
  return sampler == SamplerType::sobol ? select_by_integrator<SobolSampler, Intersector, Real>(integrator)
                                       : select_by_integrator<IndependentSampler, Intersector, Real>(integrator);
}

}  // namespace alhazen

// Kernels of `iterative` with which the study compares those of the CPU backends: paths that are followed one after the
// other, the report's linear scan, and single-ray traversal of a binary BVH. Compiled once per instruction set, like
// those in render/kernels.

#include "study/kernels/queries.h"
#include "core/bvh/brute_force/intersector.h"
#include "render/kernels/kernel_templates.h"

namespace ALHAZEN_CORE {

namespace {

/// Follows every path to its end before the next one starts, as the report's programs do. The rays are answered by the
/// BVH8 like those of the backends, and the image has the same bits.
template <class Real>
void take_paths_singly(const KernelRequest& request) {
  const SceneView<Real>& scene = *static_cast<const SceneView<Real>*>(request.scene);
  BlockSum<Real>* const sums = static_cast<BlockSum<Real>*>(request.sums);
  for (uint32_t b = 0; b < request.block_count; ++b)
    sums[b].begin(request.parts != nullptr || request.wants_first_point);
  take_blocks_singly<IntegratorKind::iterative, SobolSampler>(request, scene, Bvh8Intersector<Real>(scene), sums);
}

template <class Real>
RawKernel select_queries(StudyKernel kernel) {
  // They answer many queries one after the other (core/bvh/bvh8/traversal.h).
  using BruteForce = SequentialBatches<Real, BruteForceIntersector<Real>>;
  using Bvh2 = SequentialBatches<Real, Bvh2Intersector<Real>>;
  switch (kernel) {
    case StudyKernel::path_at_a_time:
      return take_paths_singly<Real>;
    case StudyKernel::linear_scan:
      return take_blocks<IntegratorKind::iterative, SobolSampler, BruteForce, Real>;
    case StudyKernel::binary_bvh:
      break;
  }
  return take_blocks<IntegratorKind::iterative, SobolSampler, Bvh2, Real>;
}

}  // namespace

RawKernel select_study_kernel(StudyKernel kernel, bool in_double) {
  return in_double ? select_queries<double>(kernel) : select_queries<float>(kernel);
}

}  // namespace ALHAZEN_CORE

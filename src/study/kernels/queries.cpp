// Kernels of `iterative` with slower ray queries, with which the study compares the CPU's BVH: the report's linear
// scan, and single-ray traversal of a binary BVH. Compiled once per instruction set, like those in render/kernels.

#include "core/bvh/brute_force/intersector.h"
#include "render/kernels/kernel_templates.h"

namespace ALHAZEN_CORE {

namespace {

template <class Real>
/// Answers many queries one after the other (core/bvh/bvh8/traversal.h).
RawKernel select_queries(bool brute_force) {
  using BruteForce = SequentialBatches<Real, BruteForceIntersector<Real>>;
  using Bvh2 = SequentialBatches<Real, Bvh2Intersector<Real>>;
  return brute_force ? take_blocks<IntegratorKind::iterative, SobolSampler, BruteForce, Real>
                     : take_blocks<IntegratorKind::iterative, SobolSampler, Bvh2, Real>;
}

}  // namespace

RawKernel select_study_kernel(bool brute_force, bool in_double) {
  return in_double ? select_queries<double>(brute_force) : select_queries<float>(brute_force);
}

}  // namespace ALHAZEN_CORE

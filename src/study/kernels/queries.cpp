// Kernels of `iterative` with slower ray queries, with which the study compares the CPU's BVH: the report's linear
// scan, and single-ray traversal of a binary BVH. Compiled once per instruction set, like those in render/kernels.

#include "core/bvh/brute_force/intersector.h"
#include "render/kernels/instances.h"

namespace ALHAZEN_CORE {

namespace {

template <class Real>
class BinaryBvhQueries : public Bvh2Intersector<Real> {
 public:
  explicit BinaryBvhQueries(const SceneView<Real>& scene, const void*) : Bvh2Intersector<Real>(scene) {}

  /// Answers many queries one after the other (core/bvh/bvh8/traversal.h).
  template <bool any_hit, class RayOf, class Limit, class Answer>
  void trace(uint32_t count, const RayOf& ray, const Limit& t_max, const Answer& answer) const {
    for (uint32_t i = 0; i < count; ++i) {
      Hit<Real> hit;
      const bool found = any_hit ? this->occluded(ray(i), t_max(i)) : this->closest_hit(ray(i), t_max(i), hit);
      answer(i, found, hit);
    }
  }

  template <class RayOf, class Limit, class Answer>
  void trace_coherent(uint32_t count, const RayOf& ray, const Limit& t_max, const Answer& answer) const {
    trace<false>(count, ray, t_max, answer);
  }
};

template <class Real>
RawKernel select_queries(bool linear) {
  return linear ? take_blocks<IntegratorKind::iterative, SobolSampler, BruteForceIntersector<Real>, Real>
                : take_blocks<IntegratorKind::iterative, SobolSampler, BinaryBvhQueries<Real>, Real>;
}

}  // namespace

RawKernel select_study_kernel(bool linear, bool in_double) {
  return in_double ? select_queries<double>(linear) : select_queries<float>(linear);
}

}  // namespace ALHAZEN_CORE

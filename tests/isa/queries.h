#pragma once

// Ray queries to the CPU's BVH, as compiled for each instruction set (queries.cpp).

#include "core/bvh/ray_intersector.h"
#include "isa/request.h"
#include "render/sample_kernel.h"

namespace alhazen::impl {

ALHAZEN_DECLARE_KERNEL(test::AnswerQueries select_answers(test::QueryMode mode, bool any_hit, bool is_double))

namespace test {

/// Uses the requested instruction set, or the best one below it that this processor supports.
template <class Real>
void answer_queries(const SceneView<Real>& scene, InstructionSet set, QueryMode mode, bool any_hit, uint32_t count,
                    const Ray<Real>* rays, const Real* limits, Hit<Real>* hits, bool* found) {
  const InstructionSet here = set < instruction_sets().back() ? set : instruction_sets().back();
  const auto select = ALHAZEN_KERNEL_OF(here, select_answers);
  select(mode, any_hit, sizeof(Real) == sizeof(double))({&scene, rays, limits, count, hits, found});
}

/// Queries one by one.
template <class Real, InstructionSet set>
class IsaIntersector {
 public:
  explicit IsaIntersector(const SceneView<Real>& scene) : scene_(&scene) {}

  bool closest_hit(const Ray<Real>& ray, Real t_max, Hit<Real>& hit) const {
    bool found;
    answer_queries(*scene_, set, QueryMode::single, false, 1, &ray, &t_max, &hit, &found);
    return found;
  }
  bool occluded(const Ray<Real>& ray, Real t_max) const {
    Hit<Real> hit;
    bool found;
    answer_queries(*scene_, set, QueryMode::single, true, 1, &ray, &t_max, &hit, &found);
    return found;
  }

 private:
  const SceneView<Real>* scene_;
};
static_assert(RayIntersector<IsaIntersector<float, InstructionSet::baseline>, float>);

}  // namespace test
}  // namespace alhazen::impl

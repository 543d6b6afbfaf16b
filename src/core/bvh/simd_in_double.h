#pragma once

// The walk through the BVH of CPUs that tests triangles in double where float is not sure of the sign of their distance
// (core/shapes/triangle.h).

#include "core/bvh/simd_traversal.h"

namespace ALHAZEN_CORE {

template <bool any_hit, bool instances, class Real>
bool walk_in_double(const SceneView<Real>& scene, const Ray<Real>& ray, Real t_max, Hit<Real>& hit) {
  SimdWalk<any_hit, instances, Real, NearestFirst<any_hit>, true> walk;
  NearestFirst<any_hit> stack;
  walk.use(&stack);
  walk.start(scene, ray, t_max);
  while (walk.step(scene)) {
  }
  hit = walk.hit();
  if (!walk.found()) hit.primitive = PrimitiveId();
  return walk.found();
}

#define ALHAZEN_WALK_IN_DOUBLE(any_hit, instances, Real) \
  template bool walk_in_double<any_hit, instances, Real>(const SceneView<Real>&, const Ray<Real>&, Real, Hit<Real>&);
ALHAZEN_WALK_IN_DOUBLE(false, false, float)
ALHAZEN_WALK_IN_DOUBLE(false, true, float)
ALHAZEN_WALK_IN_DOUBLE(true, false, float)
ALHAZEN_WALK_IN_DOUBLE(true, true, float)
ALHAZEN_WALK_IN_DOUBLE(false, false, double)
ALHAZEN_WALK_IN_DOUBLE(false, true, double)
ALHAZEN_WALK_IN_DOUBLE(true, false, double)
ALHAZEN_WALK_IN_DOUBLE(true, true, double)
#undef ALHAZEN_WALK_IN_DOUBLE

}  // namespace ALHAZEN_CORE

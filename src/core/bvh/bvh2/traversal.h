#pragma once

// Closest-hit and any-hit traversal of the binary BVH: visits the nearer child first and pushes the other on a stack.

#include "core/bvh/ray_intersector.h"
#include "core/bvh/stack.h"
#include "core/scene_view.h"
#include "core/shapes/instance.h"
#include "core/shapes/primitives.h"

namespace ALHAZEN_CORE {

/// A ray prepared for the slab test: the reciprocals of its direction, infinite for zero components, and for each axis
/// whether the ray enters a box through the high plane.
template <class Real>
struct SlabRay {
  Vec3<Real> origin;
  Vec3<Real> inverse;
  bool from_high[3];
};

template <class Real>
ALHAZEN_HD SlabRay<Real> slab_ray(const Ray<Real>& ray) {
  const Vec3<Real> inverse = Vec3<Real>{1, 1, 1} / ray.direction;
  return {ray.origin, inverse, {inverse.x < 0, inverse.y < 0, inverse.z < 0}};
}

/// Returns the distance at which the ray enters the box, or infinity if it misses the box or enters it beyond t_max.
/// The test is conservative: the far distance is increased by its rounding error (Ize 2013, "Robust BVH Ray
/// Traversal").
template <class Real>
ALHAZEN_HD ALHAZEN_INLINE Real intersect_box(const Bvh2Node<Real>& node, const SlabRay<Real>& ray, Real t_max) {
  constexpr Real raise = 1 + 2 * rounding_bound<Real>(3);
  Real t_near = 0, t_far = t_max;
  for (int axis = 0; axis < 3; ++axis) {
    const bool from_high = ray.from_high[axis];
    const Real low = (node.corners[from_high][axis] - ray.origin[axis]) * ray.inverse[axis];
    const Real high = (node.corners[!from_high][axis] - ray.origin[axis]) * ray.inverse[axis] * raise;
    t_near = low > t_near ? low : t_near;
    t_far = high < t_far ? high : t_far;
  }
  return t_near <= t_far ? t_near : infinity<Real>;
}

/// A node still to be visited, and the distance at which the ray enters it.
template <class Real>
struct Bvh2StackEntry {
  uint32_t node;
  Real t;
};

/// The ray in world space or in the object space of an instance, which owns the stack entries above `base`.
template <class Real>
struct TraversalSpace {
  SlabRay<Real> slabs;
  ShearedRay<Real> sheared;
  uint32_t instance = no_instance;
  int base = 0;
  PrimitiveId outer;  ///< hit.primitive before bound_within

  ALHAZEN_HD TraversalSpace(const SceneView<Real>& scene, const Ray<Real>& ray)
      : slabs(slab_ray(ray)), sheared(shear_ray(ray, scene.has_narrow_triangles)) {}

  ALHAZEN_HD void enter(const SceneView<Real>& scene, const Ray<Real>& ray, uint32_t entered, int height,
                        Hit<Real>& hit) {
    const Ray<Real> inner = object_ray(scene, entered, ray);
    slabs = slab_ray(inner);
    sheared = shear_ray(inner, scene.has_narrow_triangles);
    instance = entered;
    base = height;
    outer = hit.primitive;
    hit.primitive = bound_within(entered, hit);
  }

  ALHAZEN_HD void leave(const Ray<Real>& ray, Hit<Real>& hit) {
    if (hit.instance != instance) hit.primitive = outer;
    slabs = slab_ray(ray);
    sheared = shear_ray(ray, sheared.checks_narrow_triangles);
    instance = no_instance;
    base = 0;
  }
};

/// Traverses the tree and returns whether anything is hit; `any_hit` stops at the first hit. A leaf with an instance
/// holds nothing else.
template <bool any_hit, class Real, StackMaker Stacks>
ALHAZEN_HD bool traverse_bvh2(const SceneView<Real>& scene, const Ray<Real>& ray, const Stacks& stacks,
                              Hit<Real>& hit) {
  if (scene.bvh2_nodes_count == 0) return false;
  TraversalSpace<Real> space(scene, ray);
  const SlabRay<Real>& slabs = space.slabs;
  auto stack = stacks.template make<Bvh2StackEntry<Real>, 2 * max_bvh2_depth>();
  uint32_t current = 0;
  bool found = false;
  if (intersect_box(scene.bvh2_nodes[0], slabs, hit.t) == infinity<Real>) return false;
  for (;;) {
    const Bvh2Node<Real>& node = scene.bvh2_nodes[current];
    if (node.count > 0 && scene.primitives[node.first].kind() == PrimitiveKind::instance) {
      const uint32_t instance = scene.primitives[node.first].index();
      space.enter(scene, ray, instance, stack.height(), hit);
      current = scene.objects[scene.instances[instance].object].bvh2_root;
      if (intersect_box(scene.bvh2_nodes[current], slabs, hit.t) < infinity<Real>) continue;
    } else if (node.count > 0) {
      for (uint32_t i = node.first; i < node.first + node.count; ++i) {
        if (!intersect_primitive(scene, scene.primitives[i], ray, space.sheared, hit)) continue;
        hit.instance = space.instance;
        found = true;
        if (any_hit) return true;
      }
    } else {
      const Real t_left = intersect_box(scene.bvh2_nodes[node.first], slabs, hit.t);
      const Real t_right = intersect_box(scene.bvh2_nodes[node.first + 1], slabs, hit.t);
      const bool left = t_left < infinity<Real>, right = t_right < infinity<Real>;
      if (left && right) {
        const bool left_first = t_left <= t_right;
        stack.push({left_first ? node.first + 1 : node.first, left_first ? t_right : t_left});
        current = left_first ? node.first : node.first + 1;
        continue;
      }
      if (left || right) {
        current = left ? node.first : node.first + 1;
        continue;
      }
    }
    Bvh2StackEntry<Real> next;
    do {
      if (stack.height() == space.base && space.instance != no_instance) space.leave(ray, hit);
      if (stack.height() == 0) return found;
      next = stack.pop();
    } while (!(next.t <= hit.t));
    current = next.node;
  }
}

/// Answers ray queries with the binary BVH.
template <class Real, StackMaker Stacks = LocalStacks>
class Bvh2Intersector {
 public:
  ALHAZEN_HD explicit Bvh2Intersector(const SceneView<Real>& scene, const Stacks& stacks = {})
      : scene_(&scene), stacks_(stacks) {}

  ALHAZEN_HD bool closest_hit(const Ray<Real>& ray, Real t_max, Hit<Real>& hit) const {
    hit = end_of_interval(t_max);
    return traverse_bvh2<false>(*scene_, ray, stacks_, hit);
  }

  ALHAZEN_HD bool occluded(const Ray<Real>& ray, Real t_max) const {
    Hit<Real> hit = end_of_interval(t_max);
    return traverse_bvh2<true>(*scene_, ray, stacks_, hit);
  }

 private:
  const SceneView<Real>* scene_;
  Stacks stacks_;
};
static_assert(RayIntersector<Bvh2Intersector<float>, float> && RayIntersector<Bvh2Intersector<double>, double>);

}  // namespace ALHAZEN_CORE

#pragma once

// Closest-hit and any-hit queries over the binary BVH: nearer child first, a short stack of node indices.

#include "core/bvh/stack.h"
#include "core/scene_view.h"
#include "core/shapes/instance.h"
#include "core/shapes/sphere.h"
#include "core/shapes/triangle.h"

namespace ALHAZEN_CORE {

/// A ray as the slab test wants it: reciprocals of its direction (infinite where a component is zero, which the test
/// bears), and for each axis which of a node's planes it meets first.
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

/// Distance at which the ray enters the box, or infinity where it misses it or enters beyond t_max. Conservative: the
/// far distance is raised by its rounding (Ize 2013, "Robust BVH Ray Traversal"). A NaN (origin on a slab's plane,
/// direction within it) counts as inside.
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

/// What a search for the nearest hit before t_max begins with: no primitive is lower than this one.
template <class Real>
ALHAZEN_HD Hit<Real> no_hit_before(Real t_max) {
  return {t_max, 0, 0, PrimitiveId(PrimitiveKind::triangle, 0), 0};
}

/// Of hits at the same distance that of the lowest primitive counts, whatever the order in which a tree is walked.
template <class Real>
ALHAZEN_HD ALHAZEN_INLINE bool is_nearer(Real t, PrimitiveId primitive, const Hit<Real>& hit) {
  return t < hit.t || (t == hit.t && primitive.bits < hit.primitive.bits);
}

/// Tests one primitive that is no instance; on a hit nearer than `hit` replaces it by one of the world. Of triangles
/// the sheared ray alone is looked at.
template <class Real>
ALHAZEN_HD bool intersect_primitive(const SceneView<Real>& scene, PrimitiveId primitive, const Ray<Real>& ray,
                                    const ShearedRay<Real>& sheared, Hit<Real>& hit) {
  Hit<Real> found{hit.t, 0, 0, primitive};
  bool met = false;
  switch (primitive.kind()) {
    case PrimitiveKind::triangle: {
      if (primitive == sheared.left) return false;
      const uint32_t* v = scene.triangles[primitive.index()].vertex;
      met = intersect_triangle(sheared, scene.positions[v[0]], scene.positions[v[1]], scene.positions[v[2]], hit.t,
                               found.t, found.b1, found.b2);
      break;
    }
    case PrimitiveKind::sphere: {
      const SphereRecord<Real>& s = scene.spheres[primitive.index()];
      met = intersect_sphere(ray, s.center, s.radius, hit.t, found.t);
      break;
    }
    case PrimitiveKind::moving_sphere: {
      const MovingSphereRecord<Real>& s = scene.moving_spheres[primitive.index()];
      met = intersect_sphere(ray, s.center + s.motion * ray.time, s.radius, hit.t, found.t);
      break;
    }
    case PrimitiveKind::instance:
      break;
  }
  if (!met || !is_nearer(found.t, primitive, hit)) return false;
  hit = found;
  return true;
}

/// A node that is yet to be visited, and where the ray enters it.
template <class Real>
struct Bvh2StackEntry {
  uint32_t node;
  Real t;
};

/// A ray in the space where it is walked, and which instance that is of: what is above `base` on the stack lies in it.
template <class Real>
struct TraversalSpace {
  SlabRay<Real> slabs;
  ShearedRay<Real> sheared;
  uint32_t instance = no_instance;
  int base = 0;
  PrimitiveId outer;  ///< what the hit was before

  ALHAZEN_HD explicit TraversalSpace(const Ray<Real>& ray) : slabs(slab_ray(ray)), sheared(shear_ray(ray)) {}

  ALHAZEN_HD void enter(const SceneView<Real>& scene, const Ray<Real>& ray, uint32_t entered, int height,
                        Hit<Real>& hit) {
    const Ray<Real> inner = object_ray(scene, entered, ray);
    slabs = slab_ray(inner);
    sheared = shear_ray(inner);
    instance = entered;
    base = height;
    outer = hit.primitive;
    hit.primitive = bound_within(entered, hit);
  }

  ALHAZEN_HD void leave(const Ray<Real>& ray, Hit<Real>& hit) {
    if (hit.instance != instance) hit.primitive = outer;
    slabs = slab_ray(ray);
    sheared = shear_ray(ray);
    instance = no_instance;
    base = 0;
  }
};

/// Walks the tree. With `any_hit` it ends at the first primitive met before `hit.t`. Instances are alone in their leaf.
template <bool any_hit, class Real, class Stacks>
ALHAZEN_HD bool traverse_bvh2(const SceneView<Real>& scene, const Ray<Real>& ray, const Stacks& stacks,
                              Hit<Real>& hit) {
  if (scene.bvh2_nodes_count == 0) return false;
  TraversalSpace<Real> space(ray);
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

/// The ray queries that integrators ask, answered by the BVH. Embree or OptiX stand in its place.
template <class Real, class Stacks = LocalStacks>
class Bvh2Intersector {
 public:
  ALHAZEN_HD explicit Bvh2Intersector(const SceneView<Real>& scene, const Stacks& stacks = {})
      : scene_(&scene), stacks_(stacks) {}

  /// The nearest hit before t_max; among hits at the same distance that of the lowest primitive.
  ALHAZEN_HD bool closest_hit(const Ray<Real>& ray, Real t_max, Hit<Real>& hit) const {
    hit = no_hit_before(t_max);
    const bool found = traverse_bvh2<false>(*scene_, ray, stacks_, hit);
    if (!found) hit.primitive = PrimitiveId();
    return found;
  }

  /// Whether anything stands before t_max.
  ALHAZEN_HD bool occluded(const Ray<Real>& ray, Real t_max) const {
    Hit<Real> hit = no_hit_before(t_max);
    return traverse_bvh2<true>(*scene_, ray, stacks_, hit);
  }

 private:
  const SceneView<Real>* scene_;
  Stacks stacks_;
};

}  // namespace ALHAZEN_CORE

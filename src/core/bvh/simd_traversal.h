#pragma once

// Closest-hit and any-hit queries over the BVH of simd_node.h, for one ray or for many at a time. Many are walked in
// turns, a step each, what the next step of a ray reads being fetched while the others have theirs: so the waits for
// memory and for each other's results overlap. How a ray walks does not depend on the others.

#include <bit>

#include "core/bvh/simd_blocks.h"

namespace ALHAZEN_CORE {

/// A ray as boxes are tested: side * inverse - near_offset is where it enters a slab, side * inverse - far_offset where
/// it leaves it. The offsets are apart by more than rounding can add up to, the boxes too are wider (simd_box): a box
/// is never missed that holds what the primitive tests find.
struct BoxRay {
  float inverse[3], near_offset[3], far_offset[3];
  uint32_t near_row[3];  ///< which bounds of a node the ray meets first
};

/// Relative widening of rays and of boxes: a few times the rounding of float.
inline constexpr float box_slack = 4e-7f;

template <class Real>
ALHAZEN_INLINE BoxRay box_ray(const Ray<Real>& ray) {
  // Directions this close to a slab's plane do not leave it, and the offsets of coordinates up to 1e20 stay finite.
  constexpr float least_direction = 1e-18f;
  BoxRay b;
  const float reach = static_cast<float>(max_component(abs(ray.origin)));
  for (int axis = 0; axis < 3; ++axis) {
    const float d = static_cast<float>(ray.direction[axis]);
    const float inverse = 1 / (std::abs(d) > least_direction ? d : std::copysign(least_direction, d));
    const float offset = static_cast<float>(ray.origin[axis] * static_cast<Real>(inverse));
    const float slack = std::abs(inverse) * reach * box_slack;
    b.inverse[axis] = inverse;
    b.near_offset[axis] = offset + slack;
    b.far_offset[axis] = offset - slack;
    b.near_row[axis] = 2 * static_cast<uint32_t>(axis) + (inverse < 0 ? 1 : 0);
  }
  return b;
}

/// Which children the ray enters before t_max, a bit each; where goes to `entry`.
ALHAZEN_INLINE uint32_t enter_children(const SimdNode& node, const BoxRay& ray, float t_max,
                                       float (&entry)[simd_children]) {
  using V = Lanes<float, simd_children>;
  const auto side = [&](int axis, uint32_t row, float offset) {
    return multiply_subtract(V::load(node.bounds[row]), V::all(ray.inverse[axis]), V::all(offset));
  };
  const auto near = [&](int axis) { return side(axis, ray.near_row[axis], ray.near_offset[axis]); };
  const auto far = [&](int axis) { return side(axis, ray.near_row[axis] ^ 1, ray.far_offset[axis]); };
  // A number that is none counts as inside.
  const V t_near = larger(larger(near(0), near(1)), larger(near(2), V::all(0)));
  const V t_far = smaller(smaller(far(0), far(1)), smaller(far(2), V::all(t_max)));
  t_near.store(entry);
  return less_equal(t_near, t_far);
}

/// What a ray has yet to visit: the child, and above it the bits of where the ray enters it, which sort like numbers.
ALHAZEN_INLINE uint64_t simd_entry(float t, uint32_t child) {
  return static_cast<uint64_t>(std::bit_cast<uint32_t>(t)) << 32 | child;
}

/// One level of the tree leaves at most 7 children behind.
inline constexpr int max_simd_depth = max_bvh_depth + 4;
inline constexpr int simd_stack_size = (simd_children - 1) * max_simd_depth + 1;

/// One ray on its way through the tree.
template <bool any_hit, class Real>
class alignas(64) SimdWalk {
 public:
  /// `stack` has simd_stack_size entries and lies elsewhere: walks side by side are to be few cache lines each.
  ALHAZEN_INLINE void use(uint64_t* stack) { stack_ = stack; }

  ALHAZEN_INLINE void start(const SceneView<Real>& scene, const Ray<Real>& ray, Real t_max) {
    ray_ = &ray;
    box_ = box_ray(ray);
    sheared_ = shear_ray(ray);
    hit_ = no_hit_before(t_max);
    limit_to_hit();
    height_ = 0;
    found_ = false;
    // Nothing to visit but an empty leaf where there is no tree, or no ray.
    const bool is_ray = max_component(abs(ray.origin)) < infinity<Real>;
    current_ = scene.simd_nodes_count > 0 && is_ray ? 0 : SimdChild::nothing;
  }

  /// Visits what is next; false when the walk is over.
  ALHAZEN_INLINE bool step(const SceneView<Real>& scene) {
    if (SimdChild::kind(current_) == SimdChild::node) {
      const SimdNode& node = scene.simd_nodes[current_];
      float entry[simd_children];
      const uint32_t entered = enter_children(node, box_, t_max_, entry);
      if (entered != 0) {
        push(node, entry, entered);
        return true;
      }
    } else if (intersect_leaf(scene, current_, *ray_, sheared_, hit_)) {
      found_ = true;
      if (any_hit) return false;
      limit_to_hit();
    }
    return pop();
  }

  uint32_t current() const { return current_; }
  bool found() const { return found_; }
  const Hit<Real>& hit() const { return hit_; }

 private:
  /// Boxes are entered up to a little beyond the hit, whose own distance is rounded.
  ALHAZEN_INLINE void limit_to_hit() { t_max_ = static_cast<float>(hit_.t) * (1 + 8 * box_slack); }

  /// Goes to the nearest of the children entered and puts the others aside, the farthest deepest.
  ALHAZEN_INLINE void push(const SimdNode& node, const float (&entry)[simd_children], uint32_t entered) {
    const auto next = [&] {
      const int child = std::countr_zero(entered);
      entered &= entered - 1;
      return any_hit ? node.child[child] : simd_entry(entry[child], node.child[child]);
    };
    uint64_t nearest = next();
    if constexpr (any_hit) {
      for (; entered != 0; nearest = next()) stack_[height_++] = nearest;
    } else if (entered != 0) {
      const uint64_t second = next();
      const int base = height_;
      stack_[height_++] = larger(nearest, second);
      nearest = smaller(nearest, second);
      while (entered != 0) {
        uint64_t entry_left = next();
        const uint64_t farther = larger(nearest, entry_left);
        nearest = smaller(nearest, entry_left);
        int place = height_++;
        for (; place > base && stack_[place - 1] < farther; --place) stack_[place] = stack_[place - 1];
        stack_[place] = farther;
      }
    }
    current_ = static_cast<uint32_t>(nearest);
  }

  ALHAZEN_INLINE bool pop() {
    while (height_ > 0) {
      const uint64_t entry = stack_[--height_];
      if (!any_hit && !(std::bit_cast<float>(static_cast<uint32_t>(entry >> 32)) <= t_max_)) continue;
      current_ = static_cast<uint32_t>(entry);
      return true;
    }
    return false;
  }

  BoxRay box_;
  float t_max_;
  uint32_t current_;
  int height_;
  bool found_;
  const Ray<Real>* ray_;
  Hit<Real> hit_;
  ShearedRay<Real> sheared_;
  uint64_t* stack_;
};

/// Where the children of each kind lie, for fetching them without a branch.
template <class Real>
class SimdPrefetch {
 public:
  ALHAZEN_INLINE explicit SimdPrefetch(const SceneView<Real>& scene)
      : begin_{bytes_of(scene.simd_nodes), bytes_of(scene.triangle_blocks), bytes_of(scene.sphere_blocks),
               bytes_of(scene.moving_sphere_blocks)} {}

  ALHAZEN_INLINE void operator()(uint32_t child) const {
    constexpr size_t size[4] = {sizeof(SimdNode), sizeof(TriangleBlock<Real>), sizeof(SphereBlock<Real>),
                                sizeof(MovingSphereBlock<Real>)};
    const char* const at = begin_[SimdChild::kind(child)] + SimdChild::first(child) * size[SimdChild::kind(child)];
    for (int line = 0; line < 3; ++line) __builtin_prefetch(at + 64 * line);
    __builtin_prefetch(at + sizeof(SimdNode) - 1);
  }

 private:
  static const char* bytes_of(const void* array) { return static_cast<const char*>(array); }

  const char* begin_[4];
};

/// How many rays take turns.
inline constexpr uint32_t simd_walks = 12;

/// The ray queries that integrators ask, answered by the BVH of CPUs.
template <class Real>
class SimdBvhIntersector {
 public:
  explicit SimdBvhIntersector(const SceneView<Real>& scene, const void* = nullptr) : scene_(&scene) {}

  /// The nearest hit before t_max; among hits at the same distance that of the lowest primitive.
  bool closest_hit(const Ray<Real>& ray, Real t_max, Hit<Real>& hit) const { return walk<false>(ray, t_max, hit); }

  /// Whether anything stands before t_max.
  bool occluded(const Ray<Real>& ray, Real t_max) const {
    Hit<Real> hit;
    return walk<true>(ray, t_max, hit);
  }

  /// `ray(i)` and `t_max(i)` are query i of `count`; `answer(i, found, hit)` is called once for each, in any order, and
  /// need not look at the hit of an any-hit query.
  template <bool any_hit, class RayOf, class Limit, class Answer>
  void trace(uint32_t count, const RayOf& ray, const Limit& t_max, const Answer& answer) const {
    const SimdPrefetch<Real> prefetch(*scene_);
    SimdWalk<any_hit, Real> walks[simd_walks];
    uint64_t stacks[simd_walks][simd_stack_size];
    uint32_t query[simd_walks], live = 0, next = 0;
    for (; live < simd_walks && next < count; ++live, ++next) {
      query[live] = next;
      walks[live].use(stacks[live]);
      walks[live].start(*scene_, ray(next), t_max(next));
    }
    uint32_t order[simd_walks];
    for (uint32_t i = 0; i < live; ++i) order[i] = i;
    while (live > 0)
      for (uint32_t i = 0; i < live; ++i) {
        const uint32_t w = order[i];
        SimdWalk<any_hit, Real>& walk = walks[w];
        if (walk.step(*scene_)) {
          prefetch(walk.current());
          continue;
        }
        answer(query[w], walk.found(), walk.hit());
        if (next < count) {
          query[w] = next;
          walk.start(*scene_, ray(next), t_max(next));
          ++next;
        } else {
          order[i--] = order[--live];
        }
      }
  }

 private:
  template <bool any_hit>
  bool walk(const Ray<Real>& ray, Real t_max, Hit<Real>& hit) const {
    SimdWalk<any_hit, Real> walk;
    uint64_t stack[simd_stack_size];
    walk.use(stack);
    walk.start(*scene_, ray, t_max);
    while (walk.step(*scene_)) {
    }
    hit = walk.hit();
    if (!walk.found()) hit.primitive = PrimitiveId();
    return walk.found();
  }

  const SceneView<Real>* scene_;
};

}  // namespace ALHAZEN_CORE

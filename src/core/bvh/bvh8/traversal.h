#pragma once

// Single-ray traversal of the BVH8, one step at a time, with one of two kinds of stacks.

#include <bit>
#include <concepts>
#include <type_traits>

#include "core/bvh/bvh8/blocks.h"
#include "core/bvh/bvh8/ray.h"

namespace ALHAZEN_CORE {

/// Visits the nearest child first. It sorts with branches, since speculative execution hides latency when rays are not
/// interleaved.
template <bool any_hit>
class NearestFirst {
 public:
  /// Pushes all children that the ray enters but the nearest, which becomes `current`; any-hit queries do not sort.
  /// Returns false if the ray enters none.
  ALHAZEN_INLINE bool push(const Bvh8Node& node, const BoxRay& ray, float t_max, int& height, uint32_t& current) {
    const ChildIntervals entry = intersect_children(node, ray, t_max);
    uint32_t entered = entry.children();
    if (entered == 0) return false;
    float t[bvh8_width];
    entry.near.store(t);
    const auto next = [&]() -> uint64_t {
      const int child = std::countr_zero(entered);
      entered &= entered - 1;
      // Non-negative floats compare like their bit patterns.
      return any_hit ? node.child[child]
                     : static_cast<uint64_t>(std::bit_cast<uint32_t>(t[child])) << 32 | node.child[child];
    };
    uint64_t nearest = next();
    if constexpr (any_hit) {
      for (; entered != 0; nearest = next()) entries_[height++] = nearest;
    } else if (entered != 0) {
      const uint64_t second = next();
      const int base = height;
      entries_[height++] = max(nearest, second);
      nearest = min(nearest, second);
      while (entered != 0) {
        const uint64_t another = next();
        const uint64_t farther = max(nearest, another);
        nearest = min(nearest, another);
        int place = height++;
        for (; place > base && entries_[place - 1] < farther; --place) entries_[place] = entries_[place - 1];
        entries_[place] = farther;
      }
    }
    current = static_cast<uint32_t>(nearest);
    return true;
  }

  /// Pops the next child above `base` that the ray enters before t_max. Returns false if there is none.
  ALHAZEN_INLINE bool pop(float t_max, int base, int& height, uint32_t& current) const {
    while (height > base) {
      const uint64_t entry = entries_[--height];
      if (!any_hit && !(std::bit_cast<float>(static_cast<uint32_t>(entry >> 32)) <= t_max)) continue;
      current = static_cast<uint32_t>(entry);
      return true;
    }
    return false;
  }

 private:
  uint64_t entries_[bvh8_stack_size];
};

/// Visits children in the order of the ray's octant, without unpredictable branches. It is for interleaved rays, since
/// one misprediction would stall all of them.
template <bool any_hit>
class OctantFirst {
 public:
  /// Pushes all children that the ray enters.
  ALHAZEN_INLINE bool push(const Bvh8Node& node, const BoxRay& ray, float t_max, int& height, uint32_t&) {
    const ChildIntervals entry = intersect_children(node, ray, t_max);
    uint32_t entered;
    if constexpr (any_hit) {
      entered = entry.children();
      store_set_lanes(node.child, entered, child_ + height);
    } else {
      const uint32_t(&order)[bvh8_width] = octant_orders.of_octant[ray.octant];
      const ChildIntervals ordered{permuted(entry.near, order), permuted(entry.far, order)};
      entered = ordered.children();
      float t[bvh8_width];
      uint32_t child[bvh8_width];
      ordered.near.store(t);
      permute(node.child, order, child);
      store_set_lanes(t, entered, t_ + height);
      store_set_lanes(child, entered, child_ + height);
    }
    height += std::popcount(entered);
    return false;
  }

  ALHAZEN_INLINE bool pop(float t_max, int base, int& height, uint32_t& current) const {
    while (height > base) {
      --height;
      if (!any_hit && !(t_[height] <= t_max)) continue;
      current = child_[height];
      return true;
    }
    return false;
  }

 private:
  float t_[any_hit ? 1 : bvh8_stack_size];
  uint32_t child_[bvh8_stack_size];
};

/// Holds the children still to be visited. push() returns whether it set `current` to the next one.
template <class Stack>
concept Bvh8Stack = requires(Stack& stack, const Stack& unchanged, const Bvh8Node& node, const BoxRay& ray, float t_max,
                             int base, int& height, uint32_t& current) {
  { stack.push(node, ray, t_max, height, current) } -> std::same_as<bool>;
  { unchanged.pop(t_max, base, height, current) } -> std::same_as<bool>;
};

/// Traverses the BVH8 with one ray. Instances are supported only if `instances` is true.
template <bool any_hit, bool instances, class Real, Bvh8Stack Stack>
class alignas(64) Bvh8Traversal {
 public:
  /// Sets the stack, which is a separate object so that interleaved traversals take a few cache lines each.
  ALHAZEN_INLINE void use(Stack* stack) { stack_ = stack; }

  ALHAZEN_INLINE void start(const SceneView<Real>& scene, const Ray<Real>& ray, Real t_max) {
    ray_ = &ray;
    box_ = box_ray(ray);
    sheared_ = scene.triangle_blocks_count > 0 ? shear_ray(ray, scene.has_narrow_triangles) : ShearedRay<Real>{};
    hit_ = end_of_interval(t_max);
    t_max_ = box_t_max(t_max);
    height_ = 0;
    found_ = false;
    // Starts at an empty leaf if there is no tree or the ray cannot hit anything.
    current_ = scene.bvh8_nodes_count > 0 && has_finite_origin(ray) ? 0 : Bvh8Child::nothing;
    if constexpr (instances)
      space_ = {};
    else
      hit_.instance = no_instance;
  }

  /// Visits the current child. Returns false once the traversal has ended.
  ALHAZEN_INLINE bool step(const SceneView<Real>& scene) {
    if (Bvh8Child::kind(current_) == Bvh8Child::node) {
      if (stack_->push(scene.bvh8_nodes[current_], box_, t_max_, height_, current_)) return true;
    } else if (enter_if_instance(scene)) {
      return true;
    } else if (intersect_leaf(scene, current_, *ray_, sheared_, hit_)) {
      if constexpr (instances) hit_.instance = space_.instance;
      found_ = true;
      if (any_hit) return false;
      t_max_ = box_t_max(hit_.t);
    }
    if (stack_->pop(t_max_, space_.base, height_, current_)) return true;
    return leave_if_in_instance();
  }

  uint32_t current() const { return current_; }
  bool found() const { return found_; }
  const Hit<Real>& hit() const { return hit_; }

 private:
  /// The instance being traversed, which owns the stack entries above `base`.
  struct Space {
    uint32_t instance = no_instance;
    int base = 0;
    PrimitiveId outer;  ///< hit_.primitive before bound_within
  };
  struct World {
    static constexpr uint32_t instance = no_instance;
    static constexpr int base = 0;
  };

  ALHAZEN_INLINE bool enter_if_instance([[maybe_unused]] const SceneView<Real>& scene) {
    if constexpr (instances) {
      if (!Bvh8Child::is_instance(current_)) return false;
      enter_instance(scene);
      return true;
    }
    return false;
  }

  ALHAZEN_INLINE bool leave_if_in_instance() {
    if constexpr (instances) return space_.instance != no_instance && leave_instance();
    return false;
  }

  ALHAZEN_INLINE void set_ray(const Ray<Real>& ray) {
    box_ = box_ray(ray);
    sheared_ = shear_ray(ray, sheared_.checks_narrow_triangles);
  }

  /// Transforms the ray to object space and continues at the root of the object.
  ALHAZEN_NOINLINE void enter_instance(const SceneView<Real>& scene) {
    const uint32_t instance = Bvh8Child::first(current_);
    const Ray<Real> inner = object_ray(scene, instance, *ray_);
    set_ray(inner);
    space_ = {instance, height_, hit_.primitive};
    hit_.primitive = bound_within(instance, hit_);
    current_ =
        has_finite_origin(inner) ? scene.objects[scene.instances[instance].object].bvh8_root : Bvh8Child::nothing;
  }

  /// Continues in world space. Returns false if the stack is empty.
  ALHAZEN_NOINLINE bool leave_instance() {
    if (hit_.instance != space_.instance) hit_.primitive = space_.outer;
    space_ = {};
    if (!stack_->pop(t_max_, 0, height_, current_)) return false;
    set_ray(*ray_);
    return true;
  }

  BoxRay box_;
  float t_max_;
  uint32_t current_;
  int height_;
  bool found_;
  const Ray<Real>* ray_;
  Hit<Real> hit_;
  ShearedRay<Real> sheared_;
  Stack* stack_;
  [[no_unique_address]] std::conditional_t<instances, Space, World> space_;
};

}  // namespace ALHAZEN_CORE

#pragma once

// One ray on its way through the BVH of bvh8_root.h, a step at a time, and two ways to keep what it has yet to visit.

#include <bit>
#include <type_traits>

#include "core/bvh/bvh8/blocks.h"
#include "core/bvh/bvh8/ray.h"

namespace ALHAZEN_CORE {

/// The nearest child first, sorted by branches: for a ray that walks alone, where guessing ahead hides the waits.
template <bool any_hit>
class NearestFirst {
 public:
  /// Puts the children entered aside but for the nearest, which becomes `current`. False where none is entered.
  ALHAZEN_INLINE bool push(const Bvh8Node& node, const BoxRay& ray, float t_max, int& height, uint32_t& current) {
    const ChildIntervals entry = intersect_children(node, ray, t_max);
    uint32_t entered = entry.children();
    if (entered == 0) return false;
    float t[bvh8_width];
    entry.near.store(t);
    const auto next = [&]() -> uint64_t {
      const int child = std::countr_zero(entered);
      entered &= entered - 1;
      // Distances from 0 on sort as their bits do.
      return any_hit ? node.child[child]
                     : static_cast<uint64_t>(std::bit_cast<uint32_t>(t[child])) << 32 | node.child[child];
    };
    uint64_t nearest = next();
    if constexpr (any_hit) {
      for (; entered != 0; nearest = next()) entries_[height++] = nearest;
    } else if (entered != 0) {
      const uint64_t second = next();
      const int base = height;
      entries_[height++] = larger(nearest, second);
      nearest = smaller(nearest, second);
      while (entered != 0) {
        const uint64_t another = next();
        const uint64_t farther = larger(nearest, another);
        nearest = smaller(nearest, another);
        int place = height++;
        for (; place > base && entries_[place - 1] < farther; --place) entries_[place] = entries_[place - 1];
        entries_[place] = farther;
      }
    }
    current = static_cast<uint32_t>(nearest);
    return true;
  }

  /// The next of what is above `base`.
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

/// Children in the order of the ray's octant, without a branch that nobody can foresee: for rays that take turns, where
/// a wrong guess would make all of them wait.
template <bool any_hit>
class OctantFirst {
 public:
  /// Puts all children entered aside.
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

/// `instances`: whether the scene has any; where it has none, nothing is paid for them.
template <bool any_hit, bool instances, class Real, class Stack>
class alignas(64) Bvh8Traversal {
 public:
  /// `stack` lies elsewhere: walks side by side are to be few cache lines each.
  ALHAZEN_INLINE void use(Stack* stack) { stack_ = stack; }

  ALHAZEN_INLINE void start(const SceneView<Real>& scene, const Ray<Real>& ray, Real t_max) {
    ray_ = &ray;
    box_ = box_ray(ray);
    sheared_ = scene.triangle_blocks_count > 0 ? shear_ray(ray) : ShearedRay<Real>{};
    hit_ = no_hit_before(t_max);
    t_max_ = box_t_max(t_max);
    height_ = 0;
    found_ = false;
    // Nothing to visit but an empty leaf where there is no tree, or no ray.
    current_ = scene.bvh8_nodes_count > 0 && has_finite_origin(ray) ? 0 : Bvh8Child::nothing;
    if constexpr (instances)
      within_ = {};
    else
      hit_.instance = no_instance;
  }

  /// Visits what is next; false when the walk is over.
  ALHAZEN_INLINE bool step(const SceneView<Real>& scene) {
    if (Bvh8Child::kind(current_) == Bvh8Child::node) {
      if (stack_->push(scene.bvh8_nodes[current_], box_, t_max_, height_, current_)) return true;
    } else if (enter_if_instance(scene)) {
      return true;
    } else if (intersect_leaf(scene, current_, *ray_, sheared_, hit_)) {
      if constexpr (instances) hit_.instance = within_.instance;
      found_ = true;
      if (any_hit) return false;
      t_max_ = box_t_max(hit_.t);
    }
    if (stack_->pop(t_max_, within_.base, height_, current_)) return true;
    return leave_if_within();
  }

  uint32_t current() const { return current_; }
  bool found() const { return found_; }
  const Hit<Real>& hit() const { return hit_; }

 private:
  /// Where the walk is: what is above `base` on the stack lies in the instance.
  struct Within {
    uint32_t instance = no_instance;
    int base = 0;
    PrimitiveId outer;  ///< of the hit before
  };
  struct InTheWorld {
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

  ALHAZEN_INLINE bool leave_if_within() {
    if constexpr (instances) return within_.instance != no_instance && leave_instance();
    return false;
  }

  ALHAZEN_INLINE void set_ray(const Ray<Real>& ray) {
    box_ = box_ray(ray);
    sheared_ = shear_ray(ray);
  }

  /// Goes on at the root of the object, whose triangles the sheared ray alone is tested against.
  ALHAZEN_NOINLINE void enter_instance(const SceneView<Real>& scene) {
    const uint32_t instance = Bvh8Child::first(current_);
    const Ray<Real> inner = object_ray(scene, instance, *ray_);
    set_ray(inner);
    within_ = {instance, height_, hit_.primitive};
    hit_.primitive = bound_within(instance, hit_);
    current_ =
        has_finite_origin(inner) ? scene.objects[scene.instances[instance].object].bvh8_root : Bvh8Child::nothing;
  }

  /// Goes on with what was put aside before; false where there is nothing.
  ALHAZEN_NOINLINE bool leave_instance() {
    if (hit_.instance != within_.instance) hit_.primitive = within_.outer;
    within_ = {};
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
  [[no_unique_address]] std::conditional_t<instances, Within, InTheWorld> within_;
};

}  // namespace ALHAZEN_CORE

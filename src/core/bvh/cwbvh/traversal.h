#pragma once

// Traversal of the compressed wide BVH in the order of the ray's octant, with a stack of groups of siblings (Ylitie,
// Karras, Laine 2017, section 4). The box test is the one of the binary BVH (bvh2/traversal.h).

#include "core/bvh/bvh2/traversal.h"
#include "core/bvh/cwbvh/primitive.h"

namespace ALHAZEN_CORE {

/// Siblings still to be visited. For nodes, the high byte of `bits` marks them by priority, the low byte marks which of
/// the 8 children are nodes, and the first of these is at `base`. For primitives, bit i marks the one at `base` + i.
struct CwbvhGroup {
  uint32_t base, bits;
};

/// Maximum depth of a tree, where a traversal pushes at most one group per level. Each level covers at least one level
/// of the binary tree, whose leaves are split into up to two more.
inline constexpr int max_cwbvh_depth = max_bvh2_depth + 2;

ALHAZEN_HD inline uint32_t highest_bit(uint32_t x) {
#if defined(__CUDA_ARCH__)
  return 31u - static_cast<uint32_t>(__clz(static_cast<int>(x)));
#else
  return 31u - static_cast<uint32_t>(__builtin_clz(x));
#endif
}

ALHAZEN_HD inline uint32_t count_bits(uint32_t x) {
#if defined(__CUDA_ARCH__)
  return static_cast<uint32_t>(__popc(x));
#else
  return static_cast<uint32_t>(__builtin_popcount(x));
#endif
}

/// Returns 2^(biased - 127) for a biased exponent in [1, 254].
ALHAZEN_HD inline float power_of_two(uint32_t biased) {
#if defined(__CUDA_ARCH__)
  return __uint_as_float(biased << 23);
#else
  return __builtin_bit_cast(float, biased << 23);
#endif
}

/// Dequantizes a coordinate of a child's box. The builder keeps boxes conservative under this rounding.
ALHAZEN_HD ALHAZEN_INLINE float box_coordinate(float origin, float scale, uint32_t steps) {
  return origin + static_cast<float>(steps) * scale;
}

ALHAZEN_HD ALHAZEN_INLINE uint32_t byte_of(const uint32_t words[2], uint32_t child) {
  return words[child / 4] >> (8 * (child % 4)) & 255u;
}

/// Returns the children that the ray enters before t_max: nodes by priority in the high byte, and one bit per primitive
/// of the leaves below it.
ALHAZEN_HD ALHAZEN_INLINE uint32_t intersect_children(const CwbvhNode& node, const SlabRay<float>& ray, uint32_t octant,
                                                      float t_max) {
  constexpr float raise = 1 + 2 * rounding_bound<float>(3);
  const float scale[3] = {power_of_two(node.exponents_and_inner & 255u),
                          power_of_two(node.exponents_and_inner >> 8 & 255u),
                          power_of_two(node.exponents_and_inner >> 16 & 255u)};
  uint32_t hits = 0;
#if defined(__CUDA_ARCH__)
#pragma unroll
#endif
  for (uint32_t child = 0; child < CwbvhNode::children; ++child) {
    const uint32_t meta = byte_of(node.meta, child);
    float t_near = 0, t_far = t_max;
#if defined(__CUDA_ARCH__)
#pragma unroll
#endif
    for (int axis = 0; axis < 3; ++axis) {
      const float low_side = box_coordinate(node.origin[axis], scale[axis], byte_of(node.low[axis], child));
      const float high_side = box_coordinate(node.origin[axis], scale[axis], byte_of(node.high[axis], child));
      const float near_side = ray.from_high[axis] ? high_side : low_side;
      const float far_side = ray.from_high[axis] ? low_side : high_side;
      const float low = (near_side - ray.origin[axis]) * ray.inverse[axis];
      const float high = (far_side - ray.origin[axis]) * ray.inverse[axis] * raise;
      t_near = low > t_near ? low : t_near;
      t_far = high < t_far ? high : t_far;
    }
    if (!(t_near <= t_far)) continue;
    const uint32_t place = meta & 31u;
    hits |= (meta >> 5) << (place >= 24 ? place ^ (7u - octant) : place);
  }
  return hits;
}

ALHAZEN_HD ALHAZEN_INLINE uint32_t octant_of(const SlabRay<float>& ray) {
  return (ray.from_high[0] ? 1u : 0u) | (ray.from_high[1] ? 2u : 0u) | (ray.from_high[2] ? 4u : 0u);
}

/// Traverses the tree and returns whether anything is hit; `any_hit` stops at the first hit.
template <bool any_hit, StackMaker Stacks>
ALHAZEN_HD bool traverse_cwbvh(const SceneView<float>& scene, const Ray<float>& ray, const Stacks& stacks,
                               Hit<float>& hit) {
  constexpr uint32_t to_visit = 0xff000000u, root = 0x80000000u;
  if (scene.cwbvh_nodes_count == 0) return false;
  TraversalSpace<float> space(scene, ray);
  uint32_t octant = octant_of(space.slabs);
  auto stack = stacks.template make<CwbvhGroup, 2 * max_cwbvh_depth + 2>();
  bool found = false;
  CwbvhGroup nodes{0, root};
  for (;;) {
    CwbvhGroup primitives{};
    if (nodes.bits & to_visit) {
      const uint32_t bit = highest_bit(nodes.bits);
      nodes.bits &= ~(1u << bit);
      if (nodes.bits & to_visit) stack.push(nodes);
      const uint32_t slot = (bit - 24) ^ (7u - octant);
      const CwbvhNode node = scene.cwbvh_nodes[nodes.base + count_bits(nodes.bits & ((1u << slot) - 1))];
      const uint32_t hits = intersect_children(node, space.slabs, octant, hit.t);
      primitives = {node.first_primitive, hits & ~to_visit};
      nodes = {node.first_child, (hits & to_visit) | node.exponents_and_inner >> 24};
    } else {  // primitives that were pushed on entering an instance
      primitives = nodes;
      nodes.bits = 0;
    }
    while (primitives.bits != 0) {
      const uint32_t i = highest_bit(primitives.bits);
      primitives.bits &= ~(1u << i);
      const CwbvhPrimitive primitive = scene.cwbvh_primitives[primitives.base + i];
      if (primitive.id.kind() == PrimitiveKind::instance) {
        if (nodes.bits & to_visit) stack.push(nodes);
        if (primitives.bits != 0) stack.push(primitives);
        space.enter(scene, ray, primitive.id.index(), stack.height(), hit);
        octant = octant_of(space.slabs);
        nodes = {scene.objects[scene.instances[space.instance].object].cwbvh_root, root};
        break;
      }
      if (!intersect_primitive(scene, primitive, ray, space.sheared, hit)) continue;
      hit.instance = space.instance;
      found = true;
      if (any_hit) return true;
    }
    if (nodes.bits & to_visit) continue;
    if (stack.height() == space.base && space.instance != no_instance) {
      space.leave(ray, hit);
      octant = octant_of(space.slabs);
    }
    if (stack.height() == 0) return found;
    nodes = stack.pop();
  }
}

/// Answers ray queries with the compressed wide BVH.
template <StackMaker Stacks = LocalStacks>
class CwbvhIntersector {
 public:
  ALHAZEN_HD explicit CwbvhIntersector(const SceneView<float>& scene, const Stacks& stacks = {})
      : scene_(&scene), stacks_(stacks) {}

  ALHAZEN_HD bool closest_hit(const Ray<float>& ray, float t_max, Hit<float>& hit) const {
    hit = end_of_interval(t_max);
    return traverse_cwbvh<false>(*scene_, ray, stacks_, hit);
  }

  ALHAZEN_HD bool occluded(const Ray<float>& ray, float t_max) const {
    Hit<float> hit = end_of_interval(t_max);
    return traverse_cwbvh<true>(*scene_, ray, stacks_, hit);
  }

 private:
  const SceneView<float>* scene_;
  Stacks stacks_;
};
static_assert(RayIntersector<CwbvhIntersector<>, float>);

}  // namespace ALHAZEN_CORE

#pragma once

// Finds closest hits of coherent rays, such as the camera rays of one pixel: a packet with one ray per float lane of a
// register traverses the BVH8. Each child of a node is tested against all rays, or, if few rays are active, each ray
// against all children. The hit of a ray does not depend on the other rays.

#include <bit>

#include "core/bvh/bvh8/blocks.h"
#include "core/bvh/bvh8/prefetch.h"
#include "core/bvh/bvh8/ray.h"

namespace ALHAZEN_CORE {

template <class Real>
class RayPacket {
 public:
  ALHAZEN_INLINE explicit RayPacket(const Bvh8Prefetch<Real>& prefetch) : prefetch_(prefetch) {}

  static constexpr int width = max_register_bytes / static_cast<int>(sizeof(float));

  /// Loads the queries `ray(i)` and `t_max(i)` for i < `count` <= width. Returns false if the rays are not coherent
  /// enough for a packet; no other function may be called then.
  template <RayLookup<Real> RayOf, LimitLookup<Real> Limit>
  ALHAZEN_INLINE bool load(uint32_t count, const RayOf& ray, const Limit& t_max) {
    for (uint32_t i = 0; i < width; ++i) {
      const uint32_t from = i < count ? i : 0;  // surplus lanes are never active
      const Ray<Real>& r = ray(from);
      rays_[i] = &r;
      left_[i] = r.left.kind() == PrimitiveKind::triangle ? r.left : PrimitiveId();
      for (int axis = 0; axis < 3; ++axis) {
        origin_[axis][i] = r.origin[axis];
        direction_[axis][i] = r.direction[axis];
        float_origin_[axis][i] = static_cast<float>(r.origin[axis]);
        float_direction_[axis][i] = static_cast<float>(r.direction[axis]);
      }
      time_[i] = r.time;
      hits_[i] = end_of_interval(t_max(from));
      hits_[i].instance = no_instance;  // packets are only used in scenes without instances
      limit_[i] = box_t_max(hits_[i].t);
    }
    active_ = (1u << (count - 1)) * 2 - 1;
    hit_rays_ = 0;
    return make_box_rays() && shear();
  }

  void traverse(const SceneView<Real>& scene) {
    if (scene.bvh8_nodes_count == 0) return;
    checks_narrow_triangles_ = scene.has_narrow_triangles;
    height_ = 0;
    uint32_t child = 0, rays = active_;
    do {
      if (Bvh8Child::kind(child) == Bvh8Child::node)
        enter(scene.bvh8_nodes[child], rays);
      else
        intersect(scene, child, rays);
    } while (pop(child, rays));
  }

  bool found(uint32_t i) const { return hit_rays_ >> i & 1; }
  const Hit<Real>& hit(uint32_t i) const { return hits_[i]; }

 private:
  using F = Lanes<float, width>;
  using V = Lanes<Real, width>;
  static constexpr uint32_t all_rays = (1u << (width - 1)) * 2 - 1;

  /// Computes box_ray for all rays. Returns false if an origin is not finite or the octants differ.
  ALHAZEN_INLINE bool make_box_rays() {
    const F zero = F::all(0), most = F::all(infinity<float>);
    F reach = zero;
    for (int axis = 0; axis < 3; ++axis) reach = max(magnitude(F::load(float_origin_[axis])), reach);
    if (less(reach, most) != all_rays) return false;
    for (int axis = 0; axis < 3; ++axis) {
      const F d = F::load(float_direction_[axis]);
      const uint32_t negative = less(d, zero);
      if (negative != 0 && negative != all_rays) return false;
      const F least = F::all(negative ? -min_direction : min_direction);
      const F inverse = F::all(1) / where_less(F::all(min_direction), magnitude(d), d, least);
      const F offset = F::load(float_origin_[axis]) * inverse;
      const F slack = magnitude(inverse) * reach * F::all(box_slack);
      inverse.store(inverse_[axis]);
      (zero - (offset + slack)).store(near_offset_[axis]);
      (zero - (offset - slack)).store(far_offset_[axis]);
      near_row_[axis] = 2 * static_cast<uint32_t>(axis) + (negative ? 1 : 0);
    }
    return true;
  }

  /// Computes shear_ray for all rays. Returns false if their directions do not have the same longest axis.
  ALHAZEN_INLINE bool shear() {
    const V x = magnitude(V::load(direction_[0])), y = magnitude(V::load(direction_[1])),
            z = magnitude(V::load(direction_[2]));
    const uint32_t by_x = less(y, x) & less(z, x), by_y = ~less(y, x) & less(z, y);
    const int kz = by_x == all_rays ? 0 : by_y == all_rays ? 1 : 2;
    if (kz == 2 && ((by_x | by_y) & all_rays) != 0) return false;
    axis_[2] = kz;
    axis_[0] = kz == 2 ? 0 : kz + 1;
    axis_[1] = axis_[0] == 2 ? 0 : axis_[0] + 1;
    const V inverse = V::all(1) / V::load(direction_[kz]);
    (V::load(direction_[axis_[0]]) * inverse).store(shear_[0]);
    (V::load(direction_[axis_[1]]) * inverse).store(shear_[1]);
    inverse.store(shear_[2]);
    return true;
  }

  ALHAZEN_INLINE BoxRay box_ray_of(int ray) const {
    BoxRay b;
    for (int axis = 0; axis < 3; ++axis) {
      b.inverse[axis] = inverse_[axis][ray];
      b.near_offset[axis] = near_offset_[axis][ray];
      b.far_offset[axis] = far_offset_[axis][ray];
      b.near_row[axis] = near_row_[axis];
    }
    return b;
  }

  ALHAZEN_INLINE ShearedRay<Real> sheared_ray_of(int ray) const {
    return {{origin_[axis_[0]][ray], origin_[axis_[1]][ray], origin_[axis_[2]][ray]},
            {shear_[0][ray], shear_[1][ray], shear_[2][ray]},
            axis_[0],
            axis_[1],
            axis_[2],
            left_[ray]};
  }

  /// Up to this many active rays are tested one by one.
  static constexpr int max_single_rays = width / 4;

  /// Pushes the children that any ray enters, the nearest last. Children are sorted by the entry distance of their
  /// first active ray.
  ALHAZEN_INLINE void enter(const Bvh8Node& node, uint32_t rays) {
    alignas(64) float entry[bvh8_width][width];
    uint32_t entered[bvh8_width];
    if (std::popcount(rays) <= max_single_rays)
      enter_singly(node, rays, entry, entered);
    else
      enter_together(node, rays, entry, entered);
    uint64_t order[bvh8_width];
    int count = 0;
    for (uint32_t child = 0; child < bvh8_width; ++child) {
      if (entered[child] == 0) continue;
      const float t = entry[child][std::countr_zero(entered[child])];
      const uint64_t key = static_cast<uint64_t>(std::bit_cast<uint32_t>(t)) << 32 | child;
      int place = count++;
      for (; place > 0 && order[place - 1] < key; --place) order[place] = order[place - 1];
      order[place] = key;
    }
    for (int i = 0; i < count; ++i, ++height_) {
      const uint32_t child = static_cast<uint32_t>(order[i]);
      stack_entry_[height_] = F::load(entry[child]);
      stack_[height_] = {node.child[child], entered[child]};
      prefetch_(node.child[child]);
    }
  }

  ALHAZEN_INLINE void enter_together(const Bvh8Node& node, uint32_t rays, float (&entry)[bvh8_width][width],
                                     uint32_t (&entered)[bvh8_width]) const {
    const F limit = F::load(limit_);
    F inverse[3], near_offset[3], far_offset[3];
    for (int axis = 0; axis < 3; ++axis) {
      inverse[axis] = F::load(inverse_[axis]);
      near_offset[axis] = F::load(near_offset_[axis]);
      far_offset[axis] = F::load(far_offset_[axis]);
    }
    for (uint32_t child = 0; child < bvh8_width; ++child) {
      const auto side = [&](int axis, uint32_t row, const F* offset) {
        return fused_multiply_add(F::all(node.bounds[row][child]), inverse[axis], offset[axis]);
      };
      const auto near = [&](int axis) { return side(axis, near_row_[axis], near_offset); };
      const auto far = [&](int axis) { return side(axis, near_row_[axis] ^ 1, far_offset); };
      const F t_near = max(max(near(0), near(1)), max(near(2), F::all(0)));
      const F t_far = min(min(far(0), far(1)), min(far(2), limit));
      entered[child] = less_equal(t_near, t_far) & rays;
      t_near.store(entry[child]);
    }
  }

  ALHAZEN_INLINE void enter_singly(const Bvh8Node& node, uint32_t rays, float (&entry)[bvh8_width][width],
                                   uint32_t (&entered)[bvh8_width]) const {
    for (uint32_t& of_child : entered) of_child = 0;
    for (; rays != 0; rays &= rays - 1) {
      const int ray = std::countr_zero(rays);
      const ChildIntervals entered_at = intersect_children(node, box_ray_of(ray), limit_[ray]);
      float t[bvh8_width];
      entered_at.near.store(t);
      uint32_t children = entered_at.children();
      for (; children != 0; children &= children - 1) {
        const int child = std::countr_zero(children);
        entered[child] |= 1u << ray;
        entry[child][ray] = t[child];
      }
    }
  }

  /// Pops the next child that some ray still enters before its closest hit so far, and those rays.
  ALHAZEN_INLINE bool pop(uint32_t& child, uint32_t& rays) {
    while (height_ > 0) {
      --height_;
      rays = stack_[height_].rays & less_equal(stack_entry_[height_], F::load(limit_));
      if (rays == 0) continue;
      child = stack_[height_].child;
      return true;
    }
    return false;
  }

  ALHAZEN_INLINE void intersect(const SceneView<Real>& scene, uint32_t child, uint32_t rays) {
    switch (Bvh8Child::kind(child)) {
#define ALHAZEN_CASE(X, kind, Record, records, Block, blocks) \
  case Bvh8Child::records:                                    \
    return intersect_blocks_of(scene.blocks, child, rays);
      ALHAZEN_PRIMITIVES(ALHAZEN_CASE, )
#undef ALHAZEN_CASE
      default:
        break;
    }
    __builtin_unreachable();
  }

  template <class Block>
  ALHAZEN_INLINE void intersect_blocks_of(const Block* blocks, uint32_t child, uint32_t rays) {
    const Block* block = blocks + Bvh8Child::first(child);
    for (const Block* const end = block + Bvh8Child::blocks(child); block != end; ++block) {
      const int primitives = count_of(*block);
      if (std::popcount(rays) <= primitives) {
        for (uint32_t active = rays; active != 0; active &= active - 1) {
          const int ray = std::countr_zero(active);
          if (intersect_block(*block, *rays_[ray], sheared_ray_of(ray), hits_[ray])) note_hit(ray);
        }
      } else {
        for (int p = 0; p < primitives; ++p) intersect_primitive_of(*block, p, rays);
      }
    }
  }

  /// Returns the number of primitives in a block. Unused lanes repeat the index of the last one.
  template <class Block>
  static ALHAZEN_INLINE int count_of(const Block& block) {
    int count = 1;
    while (count < Block::lanes && block.index[count] != block.index[count - 1]) ++count;
    return count;
  }

  ALHAZEN_INLINE void intersect_primitive_of(const TriangleBlock<Real>& block, int p, uint32_t rays) {
    const V origin[3] = {V::load(origin_[axis_[0]]), V::load(origin_[axis_[1]]), V::load(origin_[axis_[2]])};
    const V shear[3] = {V::load(shear_[0]), V::load(shear_[1]), V::load(shear_[2])};
    const TriangleLanes<V> hits([&](int v, int k) { return V::all(block.vertex[v][axis_[k]][p]); }, origin, shear,
                                checks_narrow_triangles_);
    if ((hits.inside & rays) == 0) return;
    take(hits, hits.inside & rays, PrimitiveId(PrimitiveKind::triangle, block.index[p]));
  }

  template <class Record>
  ALHAZEN_INLINE void intersect_primitive_of(const RecordBlock<Record>& block, int p, uint32_t rays) {
    const RayLanes<V> all{{V::load(origin_[0]), V::load(origin_[1]), V::load(origin_[2])},
                          {V::load(direction_[0]), V::load(direction_[1]), V::load(direction_[2])},
                          V::load(time_)};
    const auto number = [&](int k) ALHAZEN_INLINE_LAMBDA { return V::all(block.number[k][p]); };
    const auto hits = intersect_lanes(numbers_of<Record>(number), all);
    if ((hits.crossed & rays) == 0) return;
    take(hits, hits.crossed & rays, PrimitiveId(Record::kind, block.index[p]));
  }

  /// Updates the hits of `rays` with one primitive, as take_nearest does for one ray. Comparing with `left` suffices
  /// since packets are only used in scenes without instances.
  template <class HitLanes>
  ALHAZEN_INLINE void take(const HitLanes& hits, uint32_t rays, PrimitiveId id) {
    rays &= less(V::all(0), hits.t);
    if (rays == 0) return;
    Real distance[width];
    hits.t.store(distance);
    for (; rays != 0; rays &= rays - 1) {
      const int ray = std::countr_zero(rays);
      Hit<Real>& hit = hits_[ray];
      if (id == left_[ray] || !is_nearer(distance[ray], id, hit)) continue;
      hits.fill(ray, hit);
      hit.t = distance[ray];
      hit.primitive = id;
      note_hit(ray);
    }
  }

  ALHAZEN_INLINE void note_hit(int ray) {
    hit_rays_ |= 1u << ray;
    limit_[ray] = box_t_max(hits_[ray].t);
  }

  struct Entry {
    uint32_t child, rays;
  };

  const Bvh8Prefetch<Real>& prefetch_;
  // One row per coordinate, one column per ray.
  alignas(64) float inverse_[3][width], near_offset_[3][width], far_offset_[3][width], limit_[width];
  alignas(64) float float_origin_[3][width], float_direction_[3][width];
  alignas(64) Real origin_[3][width], direction_[3][width], shear_[3][width], time_[width];
  uint32_t near_row_[3];
  int axis_[3];  ///< kx, ky, kz
  uint32_t active_ = 0, hit_rays_ = 0;
  uint32_t checks_narrow_triangles_ = 0;  ///< SceneView::has_narrow_triangles
  int height_ = 0;
  const Ray<Real>* rays_[width];
  PrimitiveId left_[width];  ///< Ray::left if it is a triangle
  Hit<Real> hits_[width];
  F stack_entry_[bvh8_stack_size];
  Entry stack_[bvh8_stack_size];
};

}  // namespace ALHAZEN_CORE

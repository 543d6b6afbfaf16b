#pragma once

// Intersects one ray with all primitives of a block at once.

#include "core/bvh/bvh8/node.h"
#include "core/bvh/bvh8/triangle_lanes.h"

namespace ALHAZEN_CORE {

/// Replaces `hit` with the nearest hit of `lanes` if that precedes it (is_nearer), and returns whether it did. Skips
/// `left`.
template <class HitLanes, class Real>
ALHAZEN_INLINE bool take_nearest(const HitLanes& hits, uint32_t lanes, const uint32_t* index, PrimitiveKind kind,
                                 PrimitiveId left, Hit<Real>& hit) {
  using V = decltype(hits.t);
  lanes &= less(V::all(0), hits.t) & less_equal(hits.t, V::all(hit.t));
  if (lanes == 0) return false;
  Real distance[sizeof(V) / sizeof(Real)];
  hits.t.store(distance);
  int nearest = -1;
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const PrimitiveId id(kind, index[lane]);
    if (id == left || !is_nearer(distance[lane], id, hit)) continue;
    hit.t = distance[lane];
    hit.primitive = id;
    nearest = lane;
  }
  if (nearest < 0) return false;
  hits.fill(nearest, hit);
  return true;
}

template <class Real>
ALHAZEN_INLINE bool intersect_block(const TriangleBlock<Real>& block, const Ray<Real>&, const ShearedRay<Real>& ray,
                                    Hit<Real>& hit) {
  using V = Lanes<Real, TriangleBlock<Real>::lanes>;
  const int axis[3] = {ray.kx, ray.ky, ray.kz};
  const V origin[3] = {V::all(ray.origin.x), V::all(ray.origin.y), V::all(ray.origin.z)};
  const V shear[3] = {V::all(ray.shear.x), V::all(ray.shear.y), V::all(ray.shear.z)};
  const TriangleLanes<V> hits([&](int v, int k) { return V::load(block.vertex[v][axis[k]]); }, origin, shear,
                              ray.checks_narrow_triangles);
  if (hits.inside == 0) return false;
  return take_nearest(hits, hits.inside, block.index, PrimitiveKind::triangle, ray.left, hit);
}

template <class Record, class Real>
ALHAZEN_INLINE bool intersect_block(const RecordBlock<Record>& block, const Ray<Real>& ray, const ShearedRay<Real>&,
                                    Hit<Real>& hit) {
  using V = Lanes<Real, RecordBlock<Record>::lanes>;
  const RayLanes<V> rays{{V::all(ray.origin.x), V::all(ray.origin.y), V::all(ray.origin.z)},
                         {V::all(ray.direction.x), V::all(ray.direction.y), V::all(ray.direction.z)},
                         V::all(ray.time)};
  const auto number = [&](int k) ALHAZEN_INLINE_LAMBDA { return V::load(block.number[k]); };
  const auto hits = intersect_lanes(numbers_of<Record>(number), rays);
  if (hits.crossed == 0) return false;
  return take_nearest(hits, hits.crossed, block.index, Record::kind, PrimitiveId(), hit);
}

template <class Block, class Real>
ALHAZEN_INLINE bool intersect_blocks(const Block* blocks, uint32_t child, const Ray<Real>& ray,
                                     const ShearedRay<Real>& sheared, Hit<Real>& hit) {
  bool is_hit = false;
  const Block* block = blocks + Bvh8Child::first(child);
  for (const Block* const end = block + Bvh8Child::blocks(child); block != end; ++block)
    is_hit |= intersect_block(*block, ray, sheared, hit);
  return is_hit;
}

/// Intersects all primitives of `child`, which is a leaf.
template <class Real>
ALHAZEN_INLINE bool intersect_leaf(const SceneView<Real>& scene, uint32_t child, const Ray<Real>& ray,
                                   const ShearedRay<Real>& sheared, Hit<Real>& hit) {
  switch (Bvh8Child::kind(child)) {
#define ALHAZEN_CASE(X, kind, Record, records, Block, blocks) \
  case Bvh8Child::records:                                    \
    return intersect_blocks(scene.blocks, child, ray, sheared, hit);
    ALHAZEN_PRIMITIVES(ALHAZEN_CASE, )
#undef ALHAZEN_CASE
    default:
      break;
  }
  __builtin_unreachable();
}

}  // namespace ALHAZEN_CORE

#pragma once

// A ray against a block of primitives at once.

#include "core/bvh/simd_node.h"
#include "core/bvh/simd_tests.h"

namespace ALHAZEN_CORE {

/// The triangles of some lanes of a block, of which the test of all of them at once is not sure.
template <class Real>
ALHAZEN_RARE bool intersect_in_double(const TriangleBlock<Real>& block, const ShearedRay<Real>& ray, uint32_t lanes,
                                      Hit<Real>& hit) {
  bool found = false;
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const auto vertex = [&](int v) {
      return Vec3<Real>{block.vertex[v][0][lane], block.vertex[v][1][lane], block.vertex[v][2][lane]};
    };
    const PrimitiveId id(PrimitiveKind::triangle, block.index[lane]);
    Real t = 0, b1 = 0, b2 = 0;
    if (!intersect_in_double(ray, vertex(0), vertex(1), vertex(2), t, b1, b2) || !is_nearer(t, id, hit)) continue;
    hit.t = t;
    hit.b1 = b1;
    hit.b2 = b2;
    hit.primitive = id;
    found = true;
  }
  return found;
}

/// Whether any of them is hit at all.
template <class Real>
ALHAZEN_RARE bool is_hit_in_double(const TriangleBlock<Real>& block, const ShearedRay<Real>& ray, uint32_t lanes) {
  Hit<Real> hit;
  hit.t = infinity<Real>;
  return intersect_in_double(block, ray, lanes, hit);
}

/// Of `lanes`, which might be hit, replaces `hit` by the nearest at a distance in (0, hit.t]. `unsure` gains those of
/// which this test is not sure: they are for intersect_in_double.
template <class Met, class Real>
ALHAZEN_INLINE bool take_nearest(const Met& met, uint32_t lanes, const uint32_t* index, PrimitiveKind kind,
                                 Hit<Real>& hit, uint32_t& unsure) {
  using V = decltype(met.t);
  lanes &= less(V::all(0), met.t) & less_equal(met.t, V::all(hit.t));
  if (lanes == 0) return false;
  const uint32_t in_doubt = met.unsure(lanes);
  unsure |= in_doubt;
  lanes &= ~in_doubt;
  if (lanes == 0) return false;
  Real distance[sizeof(V) / sizeof(Real)];
  met.t.store(distance);
  int nearest = -1;
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const PrimitiveId id(kind, index[lane]);
    if (!is_nearer(distance[lane], id, hit)) continue;
    hit.t = distance[lane];
    hit.primitive = id;
    nearest = lane;
  }
  if (nearest < 0) return false;
  met.fill(nearest, hit);
  return true;
}

template <class Real>
ALHAZEN_INLINE bool intersect_block(const TriangleBlock<Real>& block, const Ray<Real>&, const ShearedRay<Real>& ray,
                                    Hit<Real>& hit, uint32_t& unsure) {
  using V = Lanes<Real, TriangleBlock<Real>::lanes>;
  const int axis[3] = {ray.kx, ray.ky, ray.kz};
  const V origin[3] = {V::all(ray.origin.x), V::all(ray.origin.y), V::all(ray.origin.z)};
  const V shear[3] = {V::all(ray.shear.x), V::all(ray.shear.y), V::all(ray.shear.z)};
  const TriangleLanes<V> met([&](int v, int k) { return V::load(block.vertex[v][axis[k]]); }, origin, shear);
  if (met.inside == 0) return false;
  return take_nearest(met, met.inside, block.index, PrimitiveKind::triangle, hit, unsure);
}

template <class V, class Real>
ALHAZEN_INLINE bool intersect_spheres(const V (&f)[3], const Real* radii, const uint32_t* index, PrimitiveKind kind,
                                      const Ray<Real>& ray, Hit<Real>& hit) {
  const V d[3] = {V::all(ray.direction.x), V::all(ray.direction.y), V::all(ray.direction.z)};
  const SphereLanes<V> met(f, d, V::load(radii));
  if (met.crossed == 0) return false;
  uint32_t none = 0;
  return take_nearest(met, met.crossed, index, kind, hit, none);
}

template <class Real>
ALHAZEN_INLINE bool intersect_block(const SphereBlock<Real>& block, const Ray<Real>& ray, const ShearedRay<Real>&,
                                    Hit<Real>& hit, uint32_t&) {
  using V = Lanes<Real, SphereBlock<Real>::lanes>;
  const V f[3] = {V::all(ray.origin.x) - V::load(block.center[0]), V::all(ray.origin.y) - V::load(block.center[1]),
                  V::all(ray.origin.z) - V::load(block.center[2])};
  return intersect_spheres(f, block.radius, block.index, PrimitiveKind::sphere, ray, hit);
}

template <class Real>
ALHAZEN_INLINE bool intersect_block(const MovingSphereBlock<Real>& block, const Ray<Real>& ray, const ShearedRay<Real>&,
                                    Hit<Real>& hit, uint32_t&) {
  using V = Lanes<Real, MovingSphereBlock<Real>::lanes>;
  const auto from_center = [&](int axis) {
    const V center = V::load(block.center[axis]) + V::load(block.motion[axis]) * V::all(ray.time);
    return V::all(ray.origin[axis]) - center;
  };
  const V f[3] = {from_center(0), from_center(1), from_center(2)};
  return intersect_spheres(f, block.radius, block.index, PrimitiveKind::moving_sphere, ray, hit);
}

/// Triangles of which a walk was not sure: those of one block; `more`: there were others.
template <class Real>
struct Doubt {
  const TriangleBlock<Real>* block = nullptr;
  uint32_t lanes = 0;
  bool more = false;

  ALHAZEN_INLINE void add(const TriangleBlock<Real>& of, uint32_t some) {
    more = more || lanes != 0;
    block = &of;
    lanes = some;
  }
  template <class Block>
  ALHAZEN_INLINE void add(const Block&, uint32_t) {}
};

/// With `in_double` nothing stays in doubt.
template <bool in_double, class Block, class Real>
ALHAZEN_INLINE bool intersect_blocks(const Block* blocks, uint32_t child, const Ray<Real>& ray,
                                     const ShearedRay<Real>& sheared, Hit<Real>& hit, Doubt<Real>& doubt) {
  bool met = false;
  const Block* block = blocks + SimdChild::first(child);
  for (const Block* const end = block + SimdChild::blocks(child); block != end; ++block) {
    uint32_t unsure = 0;
    met |= intersect_block(*block, ray, sheared, hit, unsure);
    if constexpr (in_double)
      met |= intersect_in_double(*block, sheared, unsure, hit);
    else if (ALHAZEN_UNLIKELY(unsure != 0))
      doubt.add(*block, unsure);
  }
  return met;
}

/// All that a child that is no node holds.
template <bool in_double, class Real>
ALHAZEN_INLINE bool intersect_leaf(const SceneView<Real>& scene, uint32_t child, const Ray<Real>& ray,
                                   const ShearedRay<Real>& sheared, Hit<Real>& hit, Doubt<Real>& doubt) {
  switch (SimdChild::kind(child)) {
    case SimdChild::spheres:
      return intersect_blocks<false>(scene.sphere_blocks, child, ray, sheared, hit, doubt);
    case SimdChild::moving_spheres:
      return intersect_blocks<false>(scene.moving_sphere_blocks, child, ray, sheared, hit, doubt);
    default:
      return intersect_blocks<in_double>(scene.triangle_blocks, child, ray, sheared, hit, doubt);
  }
}

}  // namespace ALHAZEN_CORE

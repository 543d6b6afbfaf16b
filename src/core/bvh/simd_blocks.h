#pragma once

// A ray against a block of primitives at once. The arithmetic is that of core/shapes, operation by operation, so that
// hits are the same to the last bit, whatever the instruction set.

#include <bit>

#include "core/bvh/simd_node.h"
#include "core/bvh/traversal.h"
#include "core/simd/lanes.h"

namespace ALHAZEN_CORE {

/// Which lanes might be met at a distance in (0, hit.t]: replaces `hit` by the nearest of them that `accept` takes.
template <class V, class Real, class Accept>
ALHAZEN_INLINE bool take_nearest(const V& t, uint32_t lanes, const uint32_t* index, PrimitiveKind kind, Hit<Real>& hit,
                                 const Accept& accept) {
  lanes &= less(V::all(0), t) & less_equal(t, V::all(hit.t));
  if (lanes == 0) return false;
  Real distance[sizeof(V) / sizeof(Real)];
  t.store(distance);
  bool met = false;
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const PrimitiveId id(kind, index[lane]);
    if (!is_nearer(distance[lane], id, hit) || !accept(lane)) continue;
    hit.t = distance[lane];
    hit.primitive = id;
    met = true;
  }
  return met;
}

template <class Real>
ALHAZEN_INLINE bool intersect_block(const TriangleBlock<Real>& block, const Ray<Real>&, const ShearedRay<Real>& ray,
                                    Hit<Real>& hit) {
  constexpr int lanes = TriangleBlock<Real>::lanes;
  using V = Lanes<Real, lanes>;
  const V shear_x = V::all(ray.shear.x), shear_y = V::all(ray.shear.y), shear_z = V::all(ray.shear.z);
  const V origin_x = V::all(ray.origin[ray.kx]), origin_y = V::all(ray.origin[ray.ky]),
          origin_z = V::all(ray.origin[ray.kz]);
  V x[3], y[3], z[3];
  for (int v = 0; v < 3; ++v) {
    z[v] = V::load(block.vertex[v][ray.kz]) - origin_z;
    x[v] = V::load(block.vertex[v][ray.kx]) - origin_x - shear_x * z[v];
    y[v] = V::load(block.vertex[v][ray.ky]) - origin_y - shear_y * z[v];
  }
  const V zero = V::all(0);
  const V e[3] = {x[1] * y[2] - y[1] * x[2], x[2] * y[0] - y[2] * x[0], x[0] * y[1] - y[0] * x[1]};
  const uint32_t inside =
      less_equal(zero, smaller(smaller(e[0], e[1]), e[2])) | less_equal(larger(larger(e[0], e[1]), e[2]), zero);
  if (inside == 0) return false;
  // Where the sum is 0, t is infinite or not a number, and not taken.
  const V inverse = V::all(1) / (e[0] + e[1] + e[2]);
  const V t = (e[0] * (z[0] * shear_z) + e[1] * (z[1] * shear_z) + e[2] * (z[2] * shear_z)) * inverse;
  return take_nearest(t, inside, block.index, PrimitiveKind::triangle, hit, [&](int lane) {
    Vec3<Real> p[3];
    for (int v = 0; v < 3; ++v) p[v] = {x[v].lane(lane), y[v].lane(lane), z[v].lane(lane) * ray.shear.z};
    const Vec3<Real> edges{e[0].lane(lane), e[1].lane(lane), e[2].lane(lane)};
    const Real inverse_det = inverse.lane(lane);
    if (t.lane(lane) <= triangle_t_error(p, edges, inverse_det)) return false;
    hit.b1 = edges.y * inverse_det;
    hit.b2 = edges.z * inverse_det;
    return true;
  });
}

/// Spheres about `f` from their centres to the ray's origin.
template <class V, class Real>
ALHAZEN_INLINE bool intersect_spheres(const V (&f)[3], const Real* radii, const uint32_t* index, PrimitiveKind kind,
                                      const Ray<Real>& ray, Hit<Real>& hit) {
  const V d[3] = {V::all(ray.direction.x), V::all(ray.direction.y), V::all(ray.direction.z)};
  const V zero = V::all(0);
  const V b = zero - (f[0] * d[0] + f[1] * d[1] + f[2] * d[2]);
  const V closest[3] = {f[0] + d[0] * b, f[1] + d[1] * b, f[2] + d[2] * b};
  const V radius = V::load(radii);
  const V discriminant =
      radius * radius - (closest[0] * closest[0] + closest[1] * closest[1] + closest[2] * closest[2]);
  const uint32_t crossed = less_equal(zero, discriminant);
  if (crossed == 0) return false;
  const V root = square_root(discriminant);
  const V q = where_less(b, zero, b - root, b + root);
  const V c = f[0] * f[0] + f[1] * f[1] + f[2] * f[2] - radius * radius;
  const V other = c / q;
  const V near = where_less(b, zero, q, other), far = where_less(b, zero, other, q);
  return take_nearest(where_less(zero, c, near, far), crossed, index, kind, hit, [&](int) {
    hit.b1 = hit.b2 = 0;
    return true;
  });
}

template <class Real>
ALHAZEN_INLINE bool intersect_block(const SphereBlock<Real>& block, const Ray<Real>& ray, const ShearedRay<Real>&,
                                    Hit<Real>& hit) {
  using V = Lanes<Real, SphereBlock<Real>::lanes>;
  const V f[3] = {V::all(ray.origin.x) - V::load(block.center[0]), V::all(ray.origin.y) - V::load(block.center[1]),
                  V::all(ray.origin.z) - V::load(block.center[2])};
  return intersect_spheres(f, block.radius, block.index, PrimitiveKind::sphere, ray, hit);
}

template <class Real>
ALHAZEN_INLINE bool intersect_block(const MovingSphereBlock<Real>& block, const Ray<Real>& ray, const ShearedRay<Real>&,
                                    Hit<Real>& hit) {
  using V = Lanes<Real, MovingSphereBlock<Real>::lanes>;
  const auto from_center = [&](int axis) {
    const V center = V::load(block.center[axis]) + V::load(block.motion[axis]) * V::all(ray.time);
    return V::all(ray.origin[axis]) - center;
  };
  const V f[3] = {from_center(0), from_center(1), from_center(2)};
  return intersect_spheres(f, block.radius, block.index, PrimitiveKind::moving_sphere, ray, hit);
}

template <class Block, class Real>
ALHAZEN_INLINE bool intersect_blocks(const Block* blocks, uint32_t child, const Ray<Real>& ray,
                                     const ShearedRay<Real>& sheared, Hit<Real>& hit) {
  bool met = false;
  const Block* block = blocks + SimdChild::first(child);
  for (const Block* const end = block + SimdChild::blocks(child); block != end; ++block)
    met |= intersect_block(*block, ray, sheared, hit);
  return met;
}

/// All that a child that is no node holds.
template <class Real>
ALHAZEN_INLINE bool intersect_leaf(const SceneView<Real>& scene, uint32_t child, const Ray<Real>& ray,
                                   const ShearedRay<Real>& sheared, Hit<Real>& hit) {
  switch (SimdChild::kind(child)) {
    case SimdChild::spheres:
      return intersect_blocks(scene.sphere_blocks, child, ray, sheared, hit);
    case SimdChild::moving_spheres:
      return intersect_blocks(scene.moving_sphere_blocks, child, ray, sheared, hit);
    default:
      return intersect_blocks(scene.triangle_blocks, child, ray, sheared, hit);
  }
}

}  // namespace ALHAZEN_CORE

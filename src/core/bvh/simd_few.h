#pragma once

// Scenes of so few primitives that a tree is not worth its branches: as many rays at a time as a register has numbers,
// against every primitive. What a ray meets does not depend on the others, and is what a tree would find.

#include <bit>

#include "core/bvh/simd_ray.h"
#include "core/bvh/simd_tests.h"

namespace ALHAZEN_CORE {

template <class Real>
class FewPrimitives {
 public:
  explicit FewPrimitives(const SceneView<Real>& scene)
      : triangles_(scene.triangles_count), spheres_(scene.spheres_count), moving_(scene.moving_spheres_count) {
    is_few_ = scene.instances_count == 0 && triangles_ <= most_triangles && spheres_ + moving_ <= most_spheres &&
              triangles_ * most_spheres + (spheres_ + moving_) * most_triangles <= most_triangles * most_spheres;
    if (!is_few_) return;
    for (uint32_t i = 0; i < triangles_; ++i)
      for (int v = 0; v < 3; ++v)
        for (int k = 0; k < 3; ++k) triangle_[i].vertex[v][k] = scene.positions[scene.triangles[i].vertex[v]][k];
    for (uint32_t i = 0; i < spheres_; ++i) sphere_[i] = {scene.spheres[i].center, {}, scene.spheres[i].radius};
    for (uint32_t i = 0; i < moving_; ++i) {
      const MovingSphereRecord<Real>& sphere = scene.moving_spheres[i];
      sphere_[spheres_ + i] = {sphere.center, sphere.motion, sphere.radius};
    }
  }

  /// Whether the scene is one of those; else nothing else may be called.
  bool is_few() const { return is_few_; }

  /// As SimdBvhIntersector::trace. `alone(i)` is called for queries that are better off with a tree.
  template <bool any_hit, class RayOf, class Limit, class Answer, class Alone>
  void trace(uint32_t count, const RayOf& ray, const Limit& t_max, const Answer& answer, const Alone& alone) const {
    // Rays whose directions are longest along one axis are tested against triangles together.
    uint32_t group[3][width], size[3] = {};
    for (uint32_t i = 0; i < count; ++i) {
      const int axis = triangles_ > 0 ? max_axis(abs(ray(i).direction)) : 0;
      group[axis][size[axis]++] = i;
      if (size[axis] < width) continue;
      trace_group<any_hit>(group[axis], width, axis, ray, t_max, answer);
      size[axis] = 0;
    }
    for (int axis = 0; axis < 3; ++axis) {
      if (size[axis] > width / 4)
        trace_group<any_hit>(group[axis], size[axis], axis, ray, t_max, answer);
      else
        for (uint32_t i = 0; i < size[axis]; ++i) alone(group[axis][i]);
    }
  }

 private:
  static constexpr uint32_t width = most_register_bytes / sizeof(Real);
  /// Where a tree is as fast, measured on scenes of triangles only and of spheres only.
  static constexpr uint32_t most_triangles = 6 * width, most_spheres = 8 * width;
  using V = Lanes<Real, static_cast<int>(width)>;

  /// The rays of a group, a row a coordinate.
  struct Rays {
    alignas(64) Real origin[3][width], direction[3][width], time[width], limit[width];
  };

  /// What the rays have met so far: primitives are counted through, triangles before spheres before moving ones.
  struct Met {
    V t, b1, b2, which;
    uint32_t lanes = 0;

    ALHAZEN_INLINE void take(uint32_t some, const V& at, Real primitive) {
      t = choose(some, at, t);
      which = choose(some, V::all(primitive), which);
      lanes |= some;
    }
  };

  template <bool any_hit, class RayOf, class Limit, class Answer>
  ALHAZEN_INLINE void trace_group(const uint32_t* group, uint32_t size, int kz, const RayOf& ray, const Limit& t_max,
                                  const Answer& answer) const {
    Rays rays;
    for (uint32_t i = 0; i < width; ++i) {
      const uint32_t from = group[i < size ? i : 0];
      const Ray<Real>& r = ray(from);
      for (int axis = 0; axis < 3; ++axis) {
        rays.origin[axis][i] = r.origin[axis];
        rays.direction[axis][i] = r.direction[axis];
      }
      rays.time[i] = r.time;
      rays.limit[i] = i < size && can_walk(r) ? t_max(from) : Real(0);
    }
    const uint32_t wanted = (1u << (size - 1)) * 2 - 1;
    Met met;
    met.t = V::load(rays.limit);
    met.b1 = met.b2 = met.which = V::all(0);
    meet_triangles<any_hit>(rays, kz, wanted, met);
    if (spheres_ + moving_ > 0) meet_spheres<any_hit>(rays, wanted, met);
    alignas(64) Real t[width], b1[width], b2[width], which[width];
    met.t.store(t);
    met.b1.store(b1);
    met.b2.store(b2);
    met.which.store(which);
    for (uint32_t i = 0; i < size; ++i) {
      const bool found = met.lanes >> i & 1;
      answer(group[i], found, Hit<Real>{t[i], b1[i], b2[i], primitive(static_cast<uint32_t>(which[i])), no_instance});
    }
  }

  // Primitives come in the order of their identifiers, so that of those at the same distance the lowest is kept.

  template <bool any_hit>
  ALHAZEN_INLINE void meet_triangles(const Rays& rays, int kz, uint32_t wanted, Met& met) const {
    const int kx = kz == 2 ? 0 : kz + 1, ky = kx == 2 ? 0 : kx + 1;
    const int axis[3] = {kx, ky, kz};
    const V origin[3] = {V::load(rays.origin[kx]), V::load(rays.origin[ky]), V::load(rays.origin[kz])};
    const V inverse = V::all(1) / V::load(rays.direction[kz]);
    const V shear[3] = {V::load(rays.direction[kx]) * inverse, V::load(rays.direction[ky]) * inverse, inverse};
    for (uint32_t i = 0; i < triangles_; ++i) {
      const Triangle& triangle = triangle_[i];
      const TriangleLanes<V> at([&](int v, int k) { return V::all(triangle.vertex[v][axis[k]]); }, origin, shear);
      if (at.inside == 0) continue;
      uint32_t lanes = at.inside & less(V::all(0), at.t) & less(at.t, met.t);
      if (lanes == 0) continue;
      lanes &= at.accepted();
      met.take(lanes, at.t, static_cast<Real>(i));
      met.b1 = choose(lanes, at.e[1] * at.inverse, met.b1);
      met.b2 = choose(lanes, at.e[2] * at.inverse, met.b2);
      if (any_hit && (wanted & ~met.lanes) == 0) return;
    }
  }

  template <bool any_hit>
  ALHAZEN_INLINE void meet_spheres(const Rays& rays, uint32_t wanted, Met& met) const {
    const V direction[3] = {V::load(rays.direction[0]), V::load(rays.direction[1]), V::load(rays.direction[2])};
    for (uint32_t i = 0; i < spheres_ + moving_; ++i) {
      if (any_hit && (wanted & ~met.lanes) == 0) return;
      const Sphere& sphere = sphere_[i];
      const auto from_center = [&](int axis) {
        const V center = i < spheres_ ? V::all(sphere.center[axis])
                                      : V::all(sphere.center[axis]) + V::all(sphere.motion[axis]) * V::load(rays.time);
        return V::load(rays.origin[axis]) - center;
      };
      const V f[3] = {from_center(0), from_center(1), from_center(2)};
      const SphereLanes<V> at(f, direction, V::all(sphere.radius));
      if (at.crossed == 0) continue;
      const uint32_t lanes = at.crossed & less(V::all(0), at.t) & less(at.t, met.t);
      if (lanes == 0) continue;
      met.take(lanes, at.t, static_cast<Real>(triangles_ + i));
      met.b1 = choose(lanes, V::all(0), met.b1);
      met.b2 = choose(lanes, V::all(0), met.b2);
    }
  }

  PrimitiveId primitive(uint32_t which) const {
    if (which < triangles_) return {PrimitiveKind::triangle, which};
    which -= triangles_;
    if (which < spheres_) return {PrimitiveKind::sphere, which};
    return {PrimitiveKind::moving_sphere, which - spheres_};
  }

  struct Triangle {
    Real vertex[3][3];  ///< [vertex][axis]
  };
  struct Sphere {
    Vec3<Real> center, motion;
    Real radius;
  };

  uint32_t triangles_, spheres_, moving_;
  bool is_few_;
  Triangle triangle_[most_triangles];
  Sphere sphere_[most_spheres];
};

}  // namespace ALHAZEN_CORE

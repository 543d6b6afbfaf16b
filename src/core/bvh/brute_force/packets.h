#pragma once

// Brute force for scenes with so few primitives that traversing a tree does not pay: packets with one ray per SIMD lane
// are tested against every primitive. The hit of a ray does not depend on the other rays and is the same as with a
// tree.

#include <bit>

#include "core/bvh/bvh8/ray.h"
#include "core/bvh/bvh8/triangle_lanes.h"

namespace ALHAZEN_CORE {

template <class Real>
class BruteForcePackets {
 public:
  explicit BruteForcePackets(const SceneView<Real>& scene) : scene_(&scene) {
    const uint32_t triangles = scene.triangles_count, others = count_of_others(scene);
    is_worthwhile_ = scene.instances_count == 0 && triangles <= max_triangles && others <= max_others &&
                     triangles * max_others + others * max_triangles <= max_triangles * max_others && take_triangles();
  }

  /// Returns whether the scene is small enough. Otherwise no other function may be called.
  bool is_worthwhile() const { return is_worthwhile_; }

  /// Traces a batch (ray_intersector.h). Calls `single(i)` for queries that a tree answers faster: those of a last
  /// packet with few rays.
  template <bool any_hit, RayLookup<Real> RayOf, LimitLookup<Real> Limit, HitReceiver<Real> Answer, class Single>
  void trace(uint32_t count, const RayOf& ray, const Limit& t_max, const Answer& answer, const Single& single) const {
    for (uint32_t first = 0; first < count; first += width) {
      const uint32_t some = count - first < width ? count - first : width;
      if (some > width / 4)
        trace_group<any_hit>(first, some, ray, t_max, answer);
      else
        for (uint32_t i = first; i < count; ++i) single(i);
    }
  }

 private:
  static constexpr uint32_t width = max_register_bytes / sizeof(Real);
  /// Break-even counts, from which on a tree is as fast: measured on scenes of triangles only and of spheres only, for
  /// which all other kinds count.
  static constexpr uint32_t max_triangles = 7 * width, max_others = 8 * width;
  static constexpr uint32_t max_vertices = max_triangles;
  using V = Lanes<Real, static_cast<int>(width)>;

  /// The rays of a packet, one row per coordinate.
  struct Rays {
    alignas(64) Real origin[3][width], direction[3][width], time[width], limit[width];
    alignas(64) Real left[width];  ///< index of the triangle that the ray starts on, or -1
  };

  /// The closest hits so far. `which` numbers all primitives, kind by kind.
  struct Hits {
    V t, b1, b2, which;
    uint32_t lanes = 0;

    ALHAZEN_INLINE void take(uint32_t some, const V& at, Real primitive) {
      t = choose(some, at, t);
      which = choose(some, V::all(primitive), which);
      lanes |= some;
    }
  };

  /// Copies the triangles and merges vertices at the same position. Returns false if there are too many vertices.
  bool take_triangles() {
    for (uint32_t i = 0; i < scene_->triangles_count; ++i)
      for (int v = 0; v < 3; ++v) {
        const Vec3<Real>& p = scene_->positions[scene_->triangles[i].vertex[v]];
        uint32_t at = vertices_;  // searches backwards, since neighbouring triangles share vertices
        while (at > 0 && __builtin_memcmp(&vertex_[at - 1], &p, sizeof(p)) != 0) --at;
        if (at == 0) {
          if (vertices_ == max_vertices) return false;
          vertex_[vertices_++] = p;
          at = vertices_;
        }
        triangle_[i].vertex[v] = at - 1;
      }
    return true;
  }

  template <bool any_hit, RayLookup<Real> RayOf, LimitLookup<Real> Limit, HitReceiver<Real> Answer>
  ALHAZEN_INLINE void trace_group(uint32_t first, uint32_t size, const RayOf& ray, const Limit& t_max,
                                  const Answer& answer) const {
    Rays rays;
    for (uint32_t i = 0; i < width; ++i) {
      const uint32_t from = first + (i < size ? i : 0);
      const Ray<Real>& r = ray(from);
      for (int axis = 0; axis < 3; ++axis) {
        rays.origin[axis][i] = r.origin[axis];
        rays.direction[axis][i] = r.direction[axis];
      }
      rays.time[i] = r.time;
      rays.left[i] = r.left.bits < scene_->triangles_count ? static_cast<Real>(r.left.bits) : Real(-1);
      rays.limit[i] = i < size && has_finite_origin(r) ? t_max(from) : Real(0);
    }
    const uint32_t wanted = (1u << (size - 1)) * 2 - 1;
    Hits hits;
    hits.t = V::load(rays.limit);
    hits.b1 = hits.b2 = hits.which = V::all(0);
    uint32_t first_of_kind = 0;
#define ALHAZEN_INTERSECT(X, kind, Record, records, Block, blocks)                                   \
  if (scene_->records##_count > 0)                                                                   \
    intersect<any_hit>(scene_->records, scene_->records##_count, first_of_kind, rays, wanted, hits); \
  first_of_kind += scene_->records##_count;
    ALHAZEN_PRIMITIVES(ALHAZEN_INTERSECT, )
#undef ALHAZEN_INTERSECT
    alignas(64) Real t[width], b1[width], b2[width], which[width];
    hits.t.store(t);
    hits.b1.store(b1);
    hits.b2.store(b2);
    hits.which.store(which);
    for (uint32_t i = 0; i < size; ++i) {
      const bool found = hits.lanes >> i & 1;
      answer(first + i, found, Hit<Real>{t[i], b1[i], b2[i], primitive(static_cast<uint32_t>(which[i])), no_instance});
    }
  }

  // Primitives are tested in the order of their identifiers, so that the lowest wins a tie.

  template <bool any_hit>
  ALHAZEN_INLINE void intersect(const TriangleRecord*, uint32_t count, uint32_t, const Rays& rays, uint32_t wanted,
                                Hits& hits) const {
    const V d[3] = {V::load(rays.direction[0]), V::load(rays.direction[1]), V::load(rays.direction[2])};
    // Masks of the rays whose directions are longest along x and along y.
    const uint32_t x_over_y = less(magnitude(d[1]), magnitude(d[0]));
    const uint32_t along_x = x_over_y & less(magnitude(d[2]), magnitude(d[0]));
    const uint32_t along_y = ~x_over_y & less(magnitude(d[2]), magnitude(d[1]));
    const auto turned = [&](const V& x, const V& y, const V& z, V(&to)[3]) {
      to[0] = choose(along_x, y, choose(along_y, z, x));
      to[1] = choose(along_x, z, choose(along_y, x, y));
      to[2] = choose(along_x, x, choose(along_y, y, z));
    };
    V origin[3], direction[3];
    turned(V::load(rays.origin[0]), V::load(rays.origin[1]), V::load(rays.origin[2]), origin);
    turned(d[0], d[1], d[2], direction);
    const V inverse = V::all(1) / direction[2];
    const V shear[3] = {direction[0] * inverse, direction[1] * inverse, inverse};
    const V left = V::load(rays.left);
    ShearedLanes<V> sheared[max_vertices];
    for (uint32_t i = 0; i < vertices_; ++i) {
      V p[3];
      turned(V::all(vertex_[i].x), V::all(vertex_[i].y), V::all(vertex_[i].z), p);
      sheared[i] = {p, origin, shear};
    }
    for (uint32_t i = 0; i < count; ++i) {
      const uint32_t* const v = triangle_[i].vertex;
      const TriangleLanes<V> at(sheared[v[0]], sheared[v[1]], sheared[v[2]], shear[2], scene_->has_narrow_triangles);
      if (at.inside == 0) continue;
      uint32_t lanes = at.inside & less(V::all(0), at.t) & less(at.t, hits.t);
      if (lanes == 0) continue;
      lanes &= ~equal(left, V::all(static_cast<Real>(i)));
      hits.take(lanes, at.t, static_cast<Real>(i));
      hits.b1 = choose(lanes, at.e[1] * at.inverse, hits.b1);
      hits.b2 = choose(lanes, at.e[2] * at.inverse, hits.b2);
      if (any_hit && (wanted & ~hits.lanes) == 0) return;
    }
  }

  /// Intersects the records of a kind, whose first one has number `first`.
  template <bool any_hit, class Record>
  ALHAZEN_INLINE void intersect(const Record* records, uint32_t count, uint32_t first, const Rays& rays,
                                uint32_t wanted, Hits& hits) const {
    const RayLanes<V> all{{V::load(rays.origin[0]), V::load(rays.origin[1]), V::load(rays.origin[2])},
                          {V::load(rays.direction[0]), V::load(rays.direction[1]), V::load(rays.direction[2])},
                          V::load(rays.time)};
    for (uint32_t i = 0; i < count; ++i) {
      if (any_hit && (wanted & ~hits.lanes) == 0) return;
      const auto number = [&](int k) ALHAZEN_INLINE_LAMBDA { return V::all(records[i].number(k)); };
      const auto at = intersect_lanes(numbers_of<Record>(number), all);
      if (at.crossed == 0) continue;
      const uint32_t lanes = at.crossed & less(V::all(0), at.t) & less(at.t, hits.t);
      if (lanes == 0) continue;
      hits.take(lanes, at.t, static_cast<Real>(first + i));
      hits.b1 = choose(lanes, V::all(0), hits.b1);
      hits.b2 = choose(lanes, V::all(0), hits.b2);
    }
  }

  PrimitiveId primitive(uint32_t which) const {
#define ALHAZEN_NUMBERED(X, kind, Record, records, Block, blocks)           \
  if (which < scene_->records##_count) return {PrimitiveKind::kind, which}; \
  which -= scene_->records##_count;
    ALHAZEN_PRIMITIVES(ALHAZEN_NUMBERED, )
#undef ALHAZEN_NUMBERED
    return {};
  }

  static uint32_t count_of_others(const SceneView<Real>& scene) {
    uint32_t count = 0;
#define ALHAZEN_ADD(X, kind, Record, records, Block, blocks) count += scene.records##_count;
    ALHAZEN_PRIMITIVES(ALHAZEN_ADD, )
#undef ALHAZEN_ADD
    return count - scene.triangles_count;
  }

  struct Triangle {
    uint32_t vertex[3];  ///< in vertex_
  };

  const SceneView<Real>* scene_;
  bool is_worthwhile_;
  Triangle triangle_[max_triangles];
  uint32_t vertices_ = 0;
  Vec3<Real> vertex_[max_vertices];
};

}  // namespace ALHAZEN_CORE

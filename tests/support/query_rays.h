#pragma once

// Arrays of rays and of hits, and scenes of one mesh, for the tests of ray queries.

#include <limits>
#include <vector>

#include "alhazen/rays.h"
#include "queries/query_scene.h"
#include "render/settings.h"
#include "scene/scene.h"
#include "support/random.h"
#include "util/diagnostics.h"

namespace alhazen::impl::test {

inline QueryScene query_scene(const Scene& description, Precision precision = Precision::single) {
  Diagnostics diagnostics;
  return QueryScene(Scene(description), precision, 1, diagnostics);
}

template <class Number>
struct QueryRays {
  std::vector<Number> origins, directions, t_max, times;

  size_t count() const { return t_max.size(); }
  RayArrays<Number> arrays() const {
    RayArrays<Number> rays{origins.data(), directions.data(), count()};
    rays.t_max = t_max.data();
    rays.times = times.data();
    return rays;
  }
  Vec3d origin(size_t i) const { return vector(origins, i); }
  Vec3d direction(size_t i) const { return vector(directions, i); }

  void add(const Vec3d& o, const Vec3d& d, double limit = std::numeric_limits<double>::infinity(), double time = 0) {
    for (int axis = 0; axis < 3; ++axis) {
      origins.push_back(static_cast<Number>(o[axis]));
      directions.push_back(static_cast<Number>(d[axis]));
    }
    t_max.push_back(static_cast<Number>(limit));
    times.push_back(static_cast<Number>(time));
  }

  static Vec3d vector(const std::vector<Number>& from, size_t i) {
    return convert<double>(Vec3<Number>{from[3 * i], from[3 * i + 1], from[3 * i + 2]});
  }
};

/// Rays from within [-reach, reach]^3 in all directions, of lengths from 0.01 to 100, at all times. One in four has a
/// finite t_max.
template <class Number>
QueryRays<Number> random_rays(size_t count, double reach, uint64_t seed) {
  Random random(seed);
  QueryRays<Number> rays;
  for (size_t i = 0; i < count; ++i) {
    const double length = random.magnitude_between(0.01, 100);
    const double t_max = i % 4 == 0 ? random.between(0, reach) / length : std::numeric_limits<double>::infinity();
    const Vec3d origin = random.in_box(-reach, reach);
    rays.add(origin, random.on_sphere() * length, t_max, random.uniform<double>());
  }
  return rays;
}

inline Scene scene_of(const Mesh& mesh, const Transform& place = {}) {
  Scene scene;
  scene.meshes.push_back(mesh);
  Shape shape;
  shape.mesh = 0;
  shape.world_from_object = {place, place};
  scene.groups[0].shapes.push_back(shape);
  return scene;
}

/// All that closest_hits may write, set to values that it never writes.
template <class Number>
struct QueryHits {
  std::vector<Number> t, positions, normals, shading_normals, offsets, uvs, barycentrics;
  std::vector<uint32_t> primitives, shapes, instances;

  explicit QueryHits(size_t count)
      : t(count, Number(-7)),
        positions(3 * count, Number(-7)),
        normals(3 * count, Number(-7)),
        shading_normals(3 * count, Number(-7)),
        offsets(count, Number(-7)),
        uvs(2 * count, Number(-7)),
        barycentrics(2 * count, Number(-7)),
        primitives(count, 7777),
        shapes(count, 7777),
        instances(count, 7777) {}

  HitArrays<Number> arrays() {
    HitArrays<Number> hits;
    hits.t = t.data();
    hits.positions = positions.data();
    hits.normals = normals.data();
    hits.shading_normals = shading_normals.data();
    hits.offsets = offsets.data();
    hits.uvs = uvs.data();
    hits.barycentrics = barycentrics.data();
    hits.primitives = primitives.data();
    hits.shapes = shapes.data();
    hits.instances = instances.data();
    return hits;
  }
  Vec3d position(size_t i) const { return QueryRays<Number>::vector(positions, i); }
  Vec3d normal(size_t i) const { return QueryRays<Number>::vector(normals, i); }
  Vec3d shading_normal(size_t i) const { return QueryRays<Number>::vector(shading_normals, i); }

  /// Returns whether everything says that ray i missed.
  bool is_miss(size_t i) const {
    const Number none = Number(0);
    return t[i] == std::numeric_limits<Number>::infinity() && is_zero(position(i)) && is_zero(normal(i)) &&
           is_zero(shading_normal(i)) && offsets[i] == none && uvs[2 * i] == none && uvs[2 * i + 1] == none &&
           barycentrics[2 * i] == none && barycentrics[2 * i + 1] == none && primitives[i] == invalid_id &&
           shapes[i] == invalid_id && instances[i] == invalid_id;
  }

  friend bool operator==(const QueryHits&, const QueryHits&) = default;
};

}  // namespace alhazen::impl::test

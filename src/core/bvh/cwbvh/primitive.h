#pragma once

// Copies primitives into the leaves of the compressed wide BVH, and intersects the copies. The copy of an instance, or
// of a kind whose records are larger than a copy, holds only its identifier.

#include "core/bvh/cwbvh/node.h"
#include "core/shapes/primitives.h"

namespace ALHAZEN_CORE {

template <class Real>
void copy_to(CwbvhPrimitive& copy, const SceneView<Real>& scene, const TriangleRecord& triangle) {
  copy.a = convert<float>(scene.positions[triangle.vertex[0]]);
  copy.b = convert<float>(scene.positions[triangle.vertex[1]]);
  copy.c = convert<float>(scene.positions[triangle.vertex[2]]);
}

template <class Real>
void copy_to(CwbvhPrimitive& copy, const SceneView<Real>&, const SphereRecord<Real>& sphere) {
  copy.a = convert<float>(sphere.centre);
  copy.b.x = static_cast<float>(sphere.radius);
}

template <class Real>
void copy_to(CwbvhPrimitive& copy, const SceneView<Real>&, const MovingSphereRecord<Real>& sphere) {
  copy.a = convert<float>(sphere.centre);
  copy.b.x = static_cast<float>(sphere.radius);
  copy.c = convert<float>(sphere.motion);
}

template <class Real, class Record>
void copy_to(CwbvhPrimitive&, const SceneView<Real>&, const Record&) {}

template <class Real>
CwbvhPrimitive cwbvh_primitive(const SceneView<Real>& scene, PrimitiveId id) {
  CwbvhPrimitive copy{};
  copy.id = id;
  if (id.kind() != PrimitiveKind::instance)
    visit_primitive(scene, id, [&](const auto& record) { copy_to(copy, scene, record); });
  return copy;
}

/// Intersects the copy of a primitive of one kind with the scalar test, or the record itself if the copy does not hold
/// it.
template <PrimitiveKind kind>
struct CwbvhTest {
  ALHAZEN_HD static bool intersect(const SceneView<float>& scene, const CwbvhPrimitive& p, const Ray<float>& ray,
                                   const ShearedRay<float>& sheared, float t_max, Hit<float>& hit) {
    return intersect_record(scene, records_of<kind>(scene)[p.id.index()], p.id, ray, sheared, t_max, hit);
  }
};

template <>
struct CwbvhTest<PrimitiveKind::triangle> {
  ALHAZEN_HD static bool intersect(const SceneView<float>&, const CwbvhPrimitive& p, const Ray<float>&,
                                   const ShearedRay<float>& sheared, float t_max, Hit<float>& hit) {
    return p.id != sheared.left && intersect_triangle(sheared, p.a, p.b, p.c, t_max, hit.t, hit.b1, hit.b2);
  }
};

template <>
struct CwbvhTest<PrimitiveKind::sphere> {
  ALHAZEN_HD static bool intersect(const SceneView<float>&, const CwbvhPrimitive& p, const Ray<float>& ray,
                                   const ShearedRay<float>&, float t_max, Hit<float>& hit) {
    return intersect_sphere(ray, p.a, p.b.x, t_max, hit.t);
  }
};

template <>
struct CwbvhTest<PrimitiveKind::moving_sphere> {
  ALHAZEN_HD static bool intersect(const SceneView<float>&, const CwbvhPrimitive& p, const Ray<float>& ray,
                                   const ShearedRay<float>&, float t_max, Hit<float>& hit) {
    return intersect_sphere(ray, p.a + p.c * ray.time, p.b.x, t_max, hit.t);
  }
};

/// Intersects the copy of a primitive, as intersect_primitive does for its record.
ALHAZEN_HD inline bool intersect_primitive(const SceneView<float>& scene, const CwbvhPrimitive& primitive,
                                           const Ray<float>& ray, const ShearedRay<float>& sheared, Hit<float>& hit) {
  Hit<float> found{hit.t, 0, 0, primitive.id};
  bool is_hit = false;
  switch (primitive.id.kind()) {
#define ALHAZEN_CASE(X, kind, Record, records, Block, blocks)                                         \
  case PrimitiveKind::kind:                                                                           \
    is_hit = CwbvhTest<PrimitiveKind::kind>::intersect(scene, primitive, ray, sheared, hit.t, found); \
    break;
    ALHAZEN_PRIMITIVES(ALHAZEN_CASE, )
#undef ALHAZEN_CASE
    case PrimitiveKind::instance:
      break;
  }
  if (!is_hit || !is_nearer(found.t, primitive.id, hit)) return false;
  hit = found;
  return true;
}

}  // namespace ALHAZEN_CORE

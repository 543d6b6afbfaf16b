#pragma once

// Dispatches over the kinds of primitives.

#include <concepts>

#include "core/bvh/ray_intersector.h"
#include "core/scene_view.h"
#include "core/shapes/cylinder.h"
#include "core/shapes/disk.h"
#include "core/shapes/sphere.h"
#include "core/shapes/triangle.h"

namespace ALHAZEN_CORE {

/// Takes the record of a primitive of any kind.
template <class Visit, class Real>
concept PrimitiveVisitor =
#define ALHAZEN_TAKES(X, kind, Record, records, Block, blocks) std::invocable<const Visit&, const Record&>&&
    ALHAZEN_PRIMITIVES(ALHAZEN_TAKES, )
true;
#undef ALHAZEN_TAKES

/// Calls `visit` with the record of a primitive, which must not be an instance.
template <class Real, PrimitiveVisitor<Real> Visit>
ALHAZEN_HD ALHAZEN_INLINE decltype(auto) visit_primitive(const SceneView<Real>& scene, PrimitiveId primitive,
                                                         const Visit& visit) {
  switch (primitive.kind()) {
#define ALHAZEN_CASE(X, kind, Record, records, Block, blocks) \
  case PrimitiveKind::kind:                                   \
    return visit(scene.records[primitive.index()]);
    ALHAZEN_PRIMITIVES(ALHAZEN_CASE, )
#undef ALHAZEN_CASE
    case PrimitiveKind::instance:
      break;
  }
  __builtin_unreachable();
}

/// Returns the records of a kind.
template <PrimitiveKind kind, class Real>
ALHAZEN_HD ALHAZEN_INLINE const auto* records_of(const SceneView<Real>& scene) {
#define ALHAZEN_RECORDS(X, listed, Record, records, Block, blocks) \
  if constexpr (kind == PrimitiveKind::listed) return scene.records;
  ALHAZEN_PRIMITIVES(ALHAZEN_RECORDS, )
#undef ALHAZEN_RECORDS
}

/// A record of a primitive that moves linearly while the shutter is open.
template <class Record>
concept MovingRecord = requires(const Record& record) {
  record.motion;
};

/// Returns the bounding box at `time`; kinds that move have an overload.
template <class Real, class Record>
Bounds3<Real> bounds_at(const SceneView<Real>& scene, const Record& record, Real) {
  return bounds_of(scene, record);
}

/// Returns the index of a primitive's surface in scene.surfaces.
template <class Real>
ALHAZEN_HD uint32_t surface_of(const SceneView<Real>& scene, PrimitiveId primitive) {
  return visit_primitive(scene, primitive, [](const auto& record) ALHAZEN_INLINE_LAMBDA { return record.surface; });
}

/// Intersects one primitive, which must not be an instance. A hit that precedes `hit` replaces it, with no_instance as
/// its instance. `sheared` must be in the space of the primitive.
template <class Real>
ALHAZEN_HD bool intersect_primitive(const SceneView<Real>& scene, PrimitiveId primitive, const Ray<Real>& ray,
                                    const ShearedRay<Real>& sheared, Hit<Real>& hit) {
  Hit<Real> found{hit.t, 0, 0, primitive};
  const bool is_hit = visit_primitive(scene, primitive, [&](const auto& record) ALHAZEN_INLINE_LAMBDA {
    return intersect_record(scene, record, primitive, ray, sheared, hit.t, found);
  });
  if (!is_hit || !is_nearer(found.t, primitive, hit)) return false;
  hit = found;
  return true;
}

}  // namespace ALHAZEN_CORE

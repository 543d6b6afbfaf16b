#include "queries/primitive_origins.h"

#include "compile/scene_origins.h"
#include "core/scene_view.h"
#include "core/shapes/primitive_id.h"

namespace alhazen::impl {

namespace {

constexpr uint32_t kinds_of_rows = sizeof(PrimitiveOrigins::first_row) / sizeof(uint32_t);
static_assert(primitive_kinds <= kinds_of_rows);

template <class Record>
PrimitiveOrigin origin_of(const Record&, size_t, const SceneOrigins&) {
  return {0};
}

PrimitiveOrigin origin_of(const TriangleRecord&, size_t i, const SceneOrigins& origins) {
  PrimitiveOrigin origin;
  origin.primitive = origins.triangles[i].index;
  origin.turn = origins.triangles[i].turn;
  return origin;
}

template <class Record>
void add_rows(const Record* records, size_t count, PrimitiveKind kind, const SceneOrigins& origins,
              PrimitiveOrigins& out) {
  out.first_row[static_cast<uint32_t>(kind)] = static_cast<uint32_t>(out.rows.size());
  for (size_t i = 0; i < count; ++i) {
    PrimitiveOrigin row = origin_of(records[i], i, origins);
    const ShapeOrigin& surface = origins.surfaces[records[i].surface];
    row.shape = surface.shape;
    row.instance = surface.instance;
    out.rows.push_back(row);
  }
}

}  // namespace

template <class View>
PrimitiveOrigins primitive_origins(const View& scene, const SceneOrigins& origins) {
  PrimitiveOrigins out;
  size_t count = out.rows.size();
#define ALHAZEN_COUNT(X, kind, Record, records, Block, blocks) count += scene.records##_count;
  ALHAZEN_PRIMITIVES(ALHAZEN_COUNT, )
#undef ALHAZEN_COUNT
  out.rows.reserve(count);
#define ALHAZEN_ADD(X, kind, Record, records, Block, blocks) \
  add_rows(scene.records, scene.records##_count, PrimitiveKind::kind, origins, out);
  ALHAZEN_PRIMITIVES(ALHAZEN_ADD, )
#undef ALHAZEN_ADD
  return out;
}

template PrimitiveOrigins primitive_origins(const SceneView<float>&, const SceneOrigins&);
template PrimitiveOrigins primitive_origins(const SceneView<double>&, const SceneOrigins&);

}  // namespace alhazen::impl

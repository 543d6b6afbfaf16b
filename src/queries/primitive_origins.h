#pragma once

// Where the description has each primitive, in the order in which hits name them: all that the ids of a hit need is in
// one place, so that a hit costs one access to memory that is far away.

#include <cstdint>
#include <vector>

namespace alhazen::impl {

struct SceneOrigins;

/// Vertex i of the primitive, if it is a triangle, is vertex (i + turn) mod 3 of the described one.
struct PrimitiveOrigin {
  uint32_t primitive = 0xffffffffu;  ///< index of the triangle in its mesh; 0 for other shapes
  uint32_t shape = 0xffffffffu;      ///< ShapeOrigin::shape
  uint32_t instance = 0xffffffffu;   ///< ShapeOrigin::instance
  uint32_t turn = 0;
};

struct PrimitiveOrigins {
  std::vector<PrimitiveOrigin> rows{1};  ///< that of a miss, then those of all primitives, kind by kind
  uint32_t first_row[8] = {};            ///< by kind (PrimitiveKind)
};

/// Puts those of a compiled scene, a SceneView, together.
template <class View>
PrimitiveOrigins primitive_origins(const View& scene, const SceneOrigins& origins);

}  // namespace alhazen::impl

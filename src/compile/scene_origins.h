#pragma once

// Where the description has what was compiled: indices as they were before compiling (compile/instances.h).

#include <cstdint>
#include <vector>

namespace alhazen::impl {

struct ShapeOrigin {
  uint32_t shape = 0xffffffffu;     ///< index in its group
  uint32_t instance = 0xffffffffu;  ///< the instance by which it was copied into the world, or none
};

/// Vertex i of the record is vertex (i + turn) mod 3 of triangle `index` of its mesh.
struct TriangleOrigin {
  uint32_t index : 30, turn : 2;
};

/// All is empty unless it was asked for.
struct SceneOrigins {
  std::vector<TriangleOrigin> triangles;  ///< by triangle
  std::vector<ShapeOrigin> surfaces;      ///< by surface
  std::vector<uint32_t> instances;        ///< by instance: index into Scene::instances, or none for a moving mesh
};

}  // namespace alhazen::impl

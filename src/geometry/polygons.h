#pragma once

// Faces of more than three corners: kept as fans while a file is read, and cut anew where a fan is wrong.

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace alhazen {

/// Polygons among the triangles of a mesh, which come as fans about their first corner. Runs of polygons of the same
/// number of corners are one record, so that meshes of quads take no memory.
class Polygons {
 public:
  /// The last `corners` - 2 triangles of a list that holds `triangles` are one polygon.
  void add(uint64_t triangles, uint64_t corners);

  /// Cuts those polygons anew whose fan covers more than the polygon, which is so of concave ones unless they are seen
  /// whole from their first corner. All others keep their fans.
  void triangulate(Mesh& mesh) const;

 private:
  struct Run {
    uint64_t first;    ///< triangle
    uint64_t corners;  ///< of each polygon
    uint64_t count;
  };
  std::vector<Run> runs_;
};

}  // namespace alhazen

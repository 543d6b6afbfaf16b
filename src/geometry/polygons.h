#pragma once

// Faces of more than three corners: stored as fans while a file is read, and retriangulated if a fan is wrong.

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace alhazen::impl {

/// The polygons among the triangles of a mesh, which are stored as fans about their first corner. Runs of polygons with
/// equally many corners are one record, so that quad meshes take no memory.
class Polygons {
 public:
  /// Marks the last `corners` - 2 of `triangles` triangles as one polygon.
  void add(uint64_t triangles, uint64_t corners);

  /// Retriangulates polygons whose fan covers more than the polygon, which happens for concave ones unless all of the
  /// polygon is visible from the first corner. All others keep their fans.
  void triangulate(Mesh& mesh) const;

 private:
  struct Run {
    uint64_t first;    ///< first triangle
    uint64_t corners;  ///< of each polygon
    uint64_t count;
  };
  std::vector<Run> runs_;
};

}  // namespace alhazen::impl

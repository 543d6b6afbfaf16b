#pragma once

// pbrt-v4's curves as meshes: round and flat ones become tubes, ribbons become strips.

#include "io/pbrt/build.h"

namespace alhazen::impl::pbrt {

/// A curve of consecutive cubic Bezier segments.
struct Curve {
  std::vector<std::array<Vec3d, 4>> segments;
  double width0 = 1, width1 = 1;  ///< at the beginning and at the end of the whole curve
  uint32_t sides = 8;             ///< of tubes
  std::vector<Vec3d> normals;     ///< ribbons: unit length, one at each end of a segment; tubes: none
};

/// u runs along the curve, v across it; around a tube v goes to 1 and back. Tubes are open at their ends, and their
/// width, averaged over all directions, is that of the curve. The mesh is empty if the curve has no length.
Mesh tessellated_curve(const Curve& curve);

/// Reads `Shape "curve"`. Returns no_index if it has no length.
uint32_t read_curve(Build& build, ParameterList& list);

}  // namespace alhazen::impl::pbrt

#pragma once

// pbrt-v4's curves, as meshes: round and flat ones as tubes, ribbons as strips.

#include "io/pbrt/build.h"

namespace alhazen::pbrt {

/// A curve of cubic Bezier segments, each of which goes on where the one before ends.
struct Curve {
  std::vector<std::array<Vec3d, 4>> segments;
  double width0 = 1, width1 = 1;  ///< at the beginning and at the end of the whole
  uint32_t sides = 8;             ///< of tubes
  std::vector<Vec3d> normals;     ///< of ribbons, unit length, one at each end of a segment; of tubes none
};

/// u goes along the curve, v across it; round a tube it goes to 1 and back. Tubes are open at their ends and as wide in
/// the mean over all directions as the curve. Empty where the curve has no length.
Mesh tessellated_curve(const Curve& curve);

/// Reads `Shape "curve"`. no_index where it has no length.
uint32_t read_curve(Build& build, ParameterList& list);

}  // namespace alhazen::pbrt

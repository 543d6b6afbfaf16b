#pragma once

// Loop's subdivision surfaces (C. Loop, "Smooth Subdivision Surfaces Based on Triangles", 1987).

#include "scene/scene.h"

namespace alhazen::pbrt {

/// Subdivides positions and indices of `control` `levels` times, pushes the vertices to the limit surface and gives
/// them normals. Each level has four times the triangles. The edges of open meshes stay sharp curves.
Mesh loop_subdivided(Mesh control, int levels);

}  // namespace alhazen::pbrt

#pragma once

// Loop's subdivision surfaces (C. Loop, "Smooth Subdivision Surfaces Based on Triangles", 1987).

#include "scene/scene.h"

namespace alhazen::impl::pbrt {

/// Subdivides positions and indices of `control` `levels` times, moves the vertices to the limit surface and gives them
/// normals. Each level quadruples the triangles. The edges of open meshes remain sharp curves.
Mesh loop_subdivided(Mesh control, int levels);

}  // namespace alhazen::impl::pbrt

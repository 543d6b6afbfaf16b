#pragma once

// Tangents of meshes that bring none along, as glTF wants them: those of MikkTSpace (Mikkelsen 2008, "Simulation of
// Wrinkled Surfaces Revisited"), which normal maps are made for.

#include "scene/scene.h"

namespace alhazen::gltf {

/// Adds tangents that follow uv set `uv_set` (0 or 1) where the mesh has normals, that set and no tangents. Corners
/// share a tangent where position, normal and uv are the same and the uvs run the same way round; a vertex whose
/// triangles run both ways becomes two.
void add_tangents(Mesh& mesh, int uv_set);

}  // namespace alhazen::gltf

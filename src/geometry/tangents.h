#pragma once

// Tangents for meshes that lack them, as glTF requires: those of MikkTSpace (Mikkelsen 2008, "Simulation of Wrinkled
// Surfaces Revisited"), for which normal maps are made.

#include "scene/scene.h"

namespace alhazen::impl::gltf {

/// Adds tangents that follow uv set `uv_set` (0 or 1) if the mesh has normals and that set but no tangents. Corners
/// share a tangent if position, normal and uv are equal and their uvs have the same orientation; a vertex with
/// triangles of both orientations is duplicated.
void add_tangents(Mesh& mesh, int uv_set);

}  // namespace alhazen::impl::gltf

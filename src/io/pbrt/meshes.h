#pragma once

// The shapes that a scene file specifies by vertices and indices.

#include "io/pbrt/build.h"

namespace alhazen::impl::pbrt {

/// Adds a mesh to the scene. If it has normals, the winding of each triangle is made to agree with them: pbrt
/// determines the side of a surface by its normals if it has any. Throws with the location of the directive if a
/// coordinate is not finite.
uint32_t add_mesh(Build& build, const ParameterList& list, Mesh mesh);

// Each returns an index into Scene::meshes.
uint32_t read_triangle_mesh(Build& build, ParameterList& list);
uint32_t read_bilinear_mesh(Build& build, ParameterList& list);
uint32_t read_ply_mesh(Build& build, ParameterList& list);
uint32_t read_loop_subdivision(Build& build, ParameterList& list);

}  // namespace alhazen::impl::pbrt

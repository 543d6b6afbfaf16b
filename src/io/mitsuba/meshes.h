#pragma once

// The meshes of shapes: from files, and of rectangles, cubes and disks.

#include <vector>

#include "io/mitsuba/build.h"

namespace alhazen::impl::mitsuba {

/// A mesh of the scene, and whether its normals are those of the file. Those that are not follow the winding in world
/// space.
struct ReadMesh {
  uint32_t mesh = no_index;
  bool has_own_normals = false;
};

/// Reads `filename` of a shape of type obj, ply or serialized. Files that several shapes name are read once.
std::vector<ReadMesh> read_mesh_file(Build& build, ObjectReader& reader);

/// Each is made once.
uint32_t rectangle_mesh(Build& build);
uint32_t cube_mesh(Build& build);
uint32_t disk_mesh(Build& build);
/// About the z axis, of radius 1, from z = 0 to z = 1.
uint32_t cylinder_mesh(Build& build);
/// About the origin, of radius 1. Its v is 0 at +z.
uint32_t sphere_mesh(Build& build);

/// Whether an edge of the mesh belongs to one triangle alone, or to two that face different ways.
bool is_open(const Mesh& mesh);

}  // namespace alhazen::impl::mitsuba

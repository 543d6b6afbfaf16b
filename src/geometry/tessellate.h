#pragma once

// Triangle meshes of curved shapes without an intersection test of their own, with the parametrization of pbrt-v4.

#include <array>

#include "scene/scene.h"

namespace alhazen::impl::pbrt {

/// Part of a sphere about the origin: z in [z_min, z_max], phi in [0, phi_max] degrees. Normals point outward; u is
/// proportional to phi, and v to the polar angle from z_min to z_max.
Mesh tessellated_sphere(double radius, double z_min, double z_max, double phi_max);

/// Part of a cylinder about the z axis, open at its ends. Normals point outward; v is proportional to z.
Mesh tessellated_cylinder(double radius, double z_min, double z_max, double phi_max);

/// Part of a ring in the plane z = height, facing +z. The radii are enlarged so that its area is exactly that of the
/// ring. v is 0 at the outer edge and 1 at the inner one.
Mesh tessellated_disk(double radius, double inner_radius, double height, double phi_max);

/// Corners of a bilinear patch: p00, p10, p01, p11, with (u, v) = (index of p).
struct BilinearPatch {
  std::array<Vec3d, 4> corners;
  std::array<Vec3f, 4> normals;
  std::array<Vec2f, 4> uvs;
};

/// Appends the patch with positions, normals and uvs: as two triangles if it is planar and convex, else as a grid.
/// Normals are those of the patch itself if `own_normals` is false.
void append_bilinear_patch(const BilinearPatch& patch, bool own_normals, Mesh& mesh);

}  // namespace alhazen::impl::pbrt

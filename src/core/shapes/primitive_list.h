#pragma once

// Lists the kinds of primitives in the order of PrimitiveKind. PRIMITIVE(X, kind, record, records, block, blocks) gives
// the type of a kind's record, the array of records in SceneView, the type of its block in BVH8 leaves, and the array
// of blocks. X is passed through. The enum, the arrays of the scene and every dispatch expand from this list. Each kind
// implements these overloads for its record or block, all of them in a header of its own (sphere.h); those of triangles
// are in several, which are named here:
//   intersect_record   scalar intersection test (triangle.h)
//   bounds_of          bounding box (triangle.h)
//   set_interaction    position, normals and uv at a hit (interaction.h)
//   uv_density_of      uv area per surface area (attributes.h)
//   tangents_of        partial derivatives of the position with respect to u and v (tangents.h)
//   intersect_lanes    intersection test on SIMD lanes (core/bvh/bvh8/triangle_lanes.h)
// Kinds whose records fit into the copy that a leaf of the CWBVH holds, 9 numbers, may also have
//   copy_to            the copy; CwbvhTest is its intersection test (core/bvh/cwbvh/primitive.h)

#define ALHAZEN_PRIMITIVES(PRIMITIVE, X)                                                                       \
  PRIMITIVE(X, triangle, TriangleRecord, triangles, TriangleBlock<Real>, triangle_blocks)                      \
  PRIMITIVE(X, sphere, SphereRecord<Real>, spheres, RecordBlock<SphereRecord<Real>>, sphere_blocks)            \
  PRIMITIVE(X, moving_sphere, MovingSphereRecord<Real>, moving_spheres, RecordBlock<MovingSphereRecord<Real>>, \
            moving_sphere_blocks)                                                                              \
  PRIMITIVE(X, cylinder, CylinderRecord<Real>, cylinders, RecordBlock<CylinderRecord<Real>>, cylinder_blocks)  \
  PRIMITIVE(X, disk, DiskRecord<Real>, disks, RecordBlock<DiskRecord<Real>>, disk_blocks)

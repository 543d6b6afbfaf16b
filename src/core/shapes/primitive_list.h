#pragma once

// Every kind of primitive, once, in the order of PrimitiveKind: PRIMITIVE(X, kind, record, records, block, blocks)
// names its record and their array in SceneView, and its block in the leaves of the BVH8 and their array. X is handed
// on. The enum, the arrays of the scene and every dispatch expand from this list. By overloads for its record or block,
// a kind says what it does:
//   intersect_record   the scalar test (triangle.h, sphere.h)
//   bounds_of          its box (the same)
//   set_interaction    position, normals and uv of a hit (interaction.h)
//   uv_density_of      area of uv by area of the surface (attributes.h)
//   tangents_of        derivatives of the position by uv (tangents.h)
//   copy_to            its copy in a leaf of the CWBVH, and by CwbvhTest its test there (core/bvh/cwbvh/primitive.h)
//   intersect_block    its test on SIMD lanes (core/bvh/bvh8/blocks.h, packets.h), and set_lane, which fills a block
//                      (compile/bvh/bvh8_builder.cpp)

#define ALHAZEN_PRIMITIVES(PRIMITIVE, X)                                                  \
  PRIMITIVE(X, triangle, TriangleRecord, triangles, TriangleBlock<Real>, triangle_blocks) \
  PRIMITIVE(X, sphere, SphereRecord<Real>, spheres, SphereBlock<Real>, sphere_blocks)     \
  PRIMITIVE(X, moving_sphere, MovingSphereRecord<Real>, moving_spheres, MovingSphereBlock<Real>, moving_sphere_blocks)

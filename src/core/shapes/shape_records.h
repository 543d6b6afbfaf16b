#pragma once

// How shapes lie in memory. World space throughout, but for the triangles of objects, which lie in the space of theirs.

#include <cstdint>

#include "core/math/vec.h"
#include "core/shapes/primitive_id.h"

namespace ALHAZEN_CORE {

/// Vertices are indices into `positions`; normals and uvs of a vertex stand at vertex + offset of the surface.
struct TriangleRecord {
  uint32_t vertex[3];
  uint32_t surface;
};

template <class Real>
struct SphereRecord {
  Vec3<Real> center;
  Real radius;
  uint32_t surface;
  uint32_t frame;  ///< index into sphere_frames, or no_sphere_frame where no texture asks for uv
};

/// A sphere whose centre moves linearly: center + time * motion, time in [0, 1] over the shutter.
template <class Real>
struct MovingSphereRecord {
  Vec3<Real> center;
  Real radius;
  Vec3<Real> motion;
  uint32_t surface;
  uint32_t frame;
};

/// The axes of a sphere's object space in world space, for its uv coordinates: z is the polar axis.
template <class Real>
struct SphereFrame {
  Vec3<Real> x, y, z;
};

/// Triangles with trees of their own, which instances place in the world. Those of the world come before the first
/// object's, in every array.
struct ObjectRecord {
  uint32_t first_triangle, triangle_count;
  uint32_t first_primitive;  ///< in `primitives`, as many as triangles
  uint32_t bvh2_root;
  uint32_t cwbvh_root;  ///< the root in `cwbvh_nodes`
  uint32_t bvh8_root;   ///< the root in `bvh8_nodes`
};

inline constexpr uint32_t no_motion = 0xffffffffu;

/// An object in the world, where it is when the shutter opens. Rows of 3x4 matrices.
template <class Real>
struct InstanceRecord {
  Real world_from_object[3][4];
  Real object_from_world[3][4];
  uint32_t object;
  uint32_t flip_normal;  ///< 1: the front of every surface is its back
  uint32_t motion;       ///< index into instance_motions, or no_motion
};

/// What is added to world_from_object, times the time: points of the object move along straight lines.
template <class Real>
struct InstanceMotion {
  Real change[3][4];
};

inline constexpr uint32_t no_light = 0xffffffffu;
inline constexpr uint32_t no_offset = 0xffffffffu;
inline constexpr uint32_t no_sphere_frame = 0xffffffffu;

/// What the primitives of a mesh, or a sphere, have in common. An emissive triangle has a surface of its own.
struct SurfaceRecord {
  uint32_t material;
  uint32_t light;          ///< index into lights, or no_light
  uint32_t normal_offset;  ///< added to the vertex index modulo 2^32; no_offset: no shading normals
  uint32_t uv_offset;      ///< the same for uvs
  uint32_t flip_normal;    ///< 1: the normal is against the winding (triangles) or inward (spheres)
  uint32_t attributes;     ///< index into vertex_attributes, or no_offset
};

/// Where a mesh has what few meshes have, as SurfaceRecord has it of normals. no_offset: not at all.
struct AttributesRecord {
  uint32_t second_uv_offset;  ///< into uvs
  uint32_t colour_offset;
  uint32_t tangent_offset;
};

/// Linear.
struct VertexColour {
  float red, green, blue, alpha;
};

/// In the space of the positions, unit length; `handedness` is 1 where the normal of the front, tangent and bitangent
/// are right-handed, -1 where they are left-handed.
struct VertexTangent {
  float x, y, z, handedness;
};

/// Where a ray met a primitive. b1 and b2 are the barycentric weights of vertices 1 and 2; spheres leave them 0.
template <class Real>
struct Hit {
  Real t;  ///< distance along the unit direction
  Real b1{}, b2{};
  PrimitiveId primitive;
  uint32_t instance = no_instance;  ///< the instance whose object's primitive that is; no_instance: one of the world
};

}  // namespace ALHAZEN_CORE

#pragma once

// The memory layout of shapes. All are in world space, except the triangles of objects, which are in object space.
//
// Records of all kinds but triangles give their kind, and the numbers that their intersection test reads: there are
// `numbers`, and number(k) is the k-th.

#include <cstdint>

#include "core/math/field_list.h"
#include "core/math/vec.h"
#include "core/shapes/primitive_id.h"

namespace ALHAZEN_CORE {

/// Vertices are indices into `positions`. Normals and uvs of a vertex are stored at vertex + offset of the surface.
struct TriangleRecord {
  uint32_t vertex[3];
  uint32_t surface;
};

template <class Real>
struct SphereRecord {
  static constexpr PrimitiveKind kind = PrimitiveKind::sphere;
  static constexpr int numbers = 4;

  Vec3<Real> centre;
  Real radius;
  uint32_t surface;
  uint32_t frame;  ///< index into sphere_frames, or no_sphere_frame if no texture uses uv

  ALHAZEN_HD constexpr Real number(int k) const { return k < 3 ? centre[k] : radius; }
};

/// A sphere whose centre moves linearly: centre + time * motion, with time in [0, 1] over the shutter interval.
template <class Real>
struct MovingSphereRecord {
  static constexpr PrimitiveKind kind = PrimitiveKind::moving_sphere;
  static constexpr int numbers = 7;

  Vec3<Real> centre;
  Real radius;
  Vec3<Real> motion;
  uint32_t surface;
  uint32_t frame;

  ALHAZEN_HD constexpr Real number(int k) const { return k < 3 ? centre[k] : k == 3 ? radius : motion[k - 4]; }
};

/// What cylinders and disks have in common: their object space, and |phi| <= phi_max / 2 at their points, where phi is
/// the azimuth about z from x.
template <class Real>
struct QuadricRecord {
  Vec3<Real> anchor;                ///< the point (0, 0, anchor_z) of object space in world space
  Vec3<Real> object_from_world[3];  ///< rows
  Real cosine, sine;                ///< of phi_max / 2
  Real rim;                         ///< how far tests reach in object space: 1, and the error of points at the rim
  Real rim_growth;                  ///< the error of tests at the rim, in object space per distance along the ray
  Real anchor_z;
  Real phi_max;                     ///< in radians
  Vec3<Real> world_from_object[3];  ///< columns
  uint32_t surface;

  ALHAZEN_HD constexpr Real number(int k) const {
    if (k < 12) return k < 3 ? anchor[k] : object_from_world[k / 3 - 1][k % 3];
    return k == 12 ? cosine : k == 13 ? sine : k == 14 ? rim : rim_growth;
  }

  template <auto... more>
  using FieldsAnd =
      FieldList<&QuadricRecord::anchor, &QuadricRecord::object_from_world, &QuadricRecord::cosine, &QuadricRecord::sine,
                &QuadricRecord::rim, &QuadricRecord::rim_growth, &QuadricRecord::anchor_z, &QuadricRecord::phi_max,
                &QuadricRecord::world_from_object, &QuadricRecord::surface, more...>;
};

/// Part of a cylinder: points with x^2 + y^2 = 1 and |z| <= 1 in object space. The anchor is the end that is closest to
/// the origin of the world, so that errors are relative to the coordinates of points, however long the cylinder is.
template <class Real>
struct CylinderRecord : QuadricRecord<Real> {
  static constexpr PrimitiveKind kind = PrimitiveKind::cylinder;
  static constexpr int numbers = 17;

  ALHAZEN_HD constexpr Real number(int k) const { return k < 16 ? QuadricRecord<Real>::number(k) : this->anchor_z; }

  using Fields = typename QuadricRecord<Real>::template FieldsAnd<>;
};

/// Part of a disk: points with z = 0 and inner_radius^2 <= x^2 + y^2 <= 1 in object space.
template <class Real>
struct DiskRecord : QuadricRecord<Real> {
  static constexpr PrimitiveKind kind = PrimitiveKind::disk;
  static constexpr int numbers = 17;

  Real inner_rim;  ///< inner_radius, and the error of points there: inwards
  Real inner_radius;

  ALHAZEN_HD constexpr Real number(int k) const { return k < 16 ? QuadricRecord<Real>::number(k) : inner_rim; }

  using Fields = typename QuadricRecord<Real>::template FieldsAnd<&DiskRecord::inner_rim, &DiskRecord::inner_radius>;
};

/// The axes of a sphere's object space in world space, for its uv coordinates: z is the polar axis.
template <class Real>
struct SphereFrame {
  Vec3<Real> x, y, z;
};

/// Triangles with their own BVH, which instances place in the world. In every array, the elements of the world precede
/// those of the first object.
struct ObjectRecord {
  uint32_t first_triangle, triangle_count;
  uint32_t first_primitive;  ///< in `primitives`; there are triangle_count of them
  uint32_t bvh2_root;
  uint32_t cwbvh_root;  ///< the root in `cwbvh_nodes`
  uint32_t bvh8_root;   ///< the root in `bvh8_nodes`
};

inline constexpr uint32_t no_motion = 0xffffffffu;

/// Ids of named objects and of materials start at 1 (scene/scene_names.h). They are set only if a layer shows them.
inline constexpr uint32_t no_id = 0;

/// Places an object in the world, at shutter open. The transforms are 3x4 matrices, stored row by row.
template <class Real>
struct InstanceRecord {
  Real world_from_object[3][4];
  Real object_from_world[3][4];
  uint32_t object;
  uint32_t flip_normal;  ///< 1: swaps the front and back of every surface
  uint32_t motion;       ///< index into instance_motions, or no_motion
  uint32_t object_id;    ///< instead of those of its surfaces

  using Fields =
      FieldList<&InstanceRecord::world_from_object, &InstanceRecord::object_from_world, &InstanceRecord::object,
                &InstanceRecord::flip_normal, &InstanceRecord::motion, &InstanceRecord::object_id>;
};

/// The change of world_from_object per unit of time: points of the object move along straight lines.
template <class Real>
struct InstanceMotion {
  Real change[3][4];
};

inline constexpr uint32_t no_light = 0xffffffffu;
inline constexpr uint32_t no_offset = 0xffffffffu;
inline constexpr uint32_t no_sphere_frame = 0xffffffffu;

/// The properties of a shape. Each emissive triangle has its own surface.
struct SurfaceRecord {
  uint32_t material;
  uint32_t light;          ///< index into lights, or no_light
  uint32_t normal_offset;  ///< added to the vertex index modulo 2^32; no_offset if there are no shading normals
  uint32_t uv_offset;      ///< the same for uvs
  uint32_t flip_normal;    ///< 1: reverses the normal (a sphere's or cylinder's then points inward)
  uint32_t attributes;     ///< index into vertex_attributes, or no_offset
  uint32_t object_id = no_id, material_id = no_id;
};

/// Offsets of the optional vertex attributes of a mesh, used like SurfaceRecord::normal_offset; no_offset if absent.
struct AttributesRecord {
  uint32_t second_uv_offset;  ///< into uvs
  uint32_t colour_offset;
  uint32_t tangent_offset;
};

/// A colour with linear components.
struct VertexColour {
  float red, green, blue, alpha;
};

/// A unit tangent in the space of the positions. `handedness` is 1 if the front normal, tangent and bitangent are
/// right-handed, and -1 if they are left-handed.
struct VertexTangent {
  float x, y, z, handedness;
};

/// The hit of a ray on a primitive. b1 and b2 are the barycentric coordinates of vertices 1 and 2; they are 0 for
/// other shapes.
template <class Real>
struct Hit {
  Real t;  ///< distance along the ray's unit direction
  Real b1{}, b2{};
  PrimitiveId primitive;
  uint32_t instance = no_instance;  ///< the instance that was hit, or no_instance for primitives of the world

  using Fields = FieldList<&Hit::t, &Hit::b1, &Hit::b2, &Hit::primitive, &Hit::instance>;
};

}  // namespace ALHAZEN_CORE

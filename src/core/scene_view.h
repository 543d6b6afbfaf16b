#pragma once

// The compiled scene: plain records in arrays, and the view of pointers and counts that integrators use. Ids are
// indices, so the same bytes are valid on every device.

#include <cstdint>

#include "core/bvh/bvh2/node.h"
#include "core/bvh/bvh8/node.h"
#include "core/bvh/cwbvh/node.h"
#include "core/cameras/camera.h"
#include "core/cameras/filter.h"
#include "core/guiding/guide.h"
#include "core/lights/light_record.h"
#include "core/materials/material_record.h"
#include "core/math/bounds.h"
#include "core/shapes/shape_records.h"
#include "core/textures/texture_record.h"

namespace ALHAZEN_CORE {

/// The two arrays of a kind of primitive.
#define ALHAZEN_PRIMITIVE_ARRAYS(ARRAY, kind, Record, records, Block, blocks) \
  ARRAY(Record, records) ARRAY(Block, blocks)

/// Lists every array of the scene once: ARRAY(element type, name), those of primitives by their own list. Storage,
/// device pointers, memory report and checksum are generated from it.
#define ALHAZEN_SCENE_ARRAYS(ARRAY)                   \
  ARRAY(Bvh2Node<Real>, bvh2_nodes)                   \
  ARRAY(CwbvhNode, cwbvh_nodes)                       \
  ARRAY(CwbvhPrimitive, cwbvh_primitives)             \
  ARRAY(Bvh8Node, bvh8_nodes)                         \
  ALHAZEN_PRIMITIVES(ALHAZEN_PRIMITIVE_ARRAYS, ARRAY) \
  ARRAY(PrimitiveId, primitives)                      \
  ARRAY(Vec3<Real>, positions)                        \
  ARRAY(Vec3<Real>, normals)                          \
  ARRAY(Vec2<Real>, uvs)                              \
  ARRAY(AttributesRecord, vertex_attributes)          \
  ARRAY(VertexColour, vertex_colours)                 \
  ARRAY(VertexTangent, vertex_tangents)               \
  ARRAY(SphereFrame<Real>, sphere_frames)             \
  ARRAY(ObjectRecord, objects)                        \
  ARRAY(InstanceRecord<Real>, instances)              \
  ARRAY(InstanceMotion<Real>, instance_motions)       \
  ARRAY(SurfaceRecord, surfaces)                      \
  ARRAY(MaterialRecord<Real>, materials)              \
  ARRAY(Real, albedo_tables)                          \
  ARRAY(TextureRecord<Real>, textures)                \
  ARRAY(TextureMapping<Real>, texture_mappings)       \
  ARRAY(ImageRecord, images)                          \
  ARRAY(uint8_t, texel_bytes)                         \
  ARRAY(float, texel_floats)                          \
  ARRAY(Real, srgb_decode_table)                      \
  ARRAY(uint8_t, noise_permutation)                   \
  ARRAY(LightRecord<Real>, lights)                    \
  ARRAY(uint32_t, far_lights)                         \
  ARRAY(uint32_t, light_groups)                       \
  ARRAY(TriangleEmitter<Real>, triangle_emitters)     \
  ARRAY(EnvironmentRecord<Real>, environments)        \
  ARRAY(Real, environment_cdf)                        \
  ARRAY(Real, light_cdf)                              \
  ARRAY(LightTreeNode, light_tree)                    \
  ARRAY(LightImageRecord<Real>, light_images)         \
  ARRAY(Real, filter_cdf)

template <class Real>
struct SceneView {
#define ALHAZEN_ARRAY(type, name) \
  const type* name = nullptr;     \
  uint32_t name##_count = 0;
  ALHAZEN_SCENE_ARRAYS(ALHAZEN_ARRAY)
#undef ALHAZEN_ARRAY

  CameraRecord<Real> camera{};
  FilterRecord<Real> filter;
  Vec3<Real> background{};            ///< radiance of the constant infinite light, which `lights` does not hold
  uint32_t background_group = 0;      ///< of that light, as light_groups are of `lights`; none if they have none
  Real infinite_irradiance = 0;       ///< what light_cdf chooses from can send to a surface, if there is a light tree
  Real exposure = 1;                  ///< factor on recorded radiance
  uint32_t has_cutouts = 0;           ///< 1 if a material lets rays through, be it only camera rays
  uint32_t lets_light_through = 0;    ///< 1 if a material lets shadow rays through
  uint32_t has_lobes = 0;             ///< 1 if a material chooses among lobes at random
  uint32_t has_narrow_triangles = 0;  ///< 1 if a triangle is much longer than wide (core/shapes/triangle.h)
  Bounds3<Real> bounds{};             ///< of all surfaces
  Real indirect_limit = 0;            ///< of each contribution of indirect light, before the exposure; 0: none
  uint32_t records_through_specular = 0;  ///< 1: a path's first hit is where it meets a surface that is not specular
  uint32_t hides_background = 0;          ///< 1: camera rays that escape gather nothing
  uint32_t sees_through_glass = 0;        ///< 1: so do those that have only been transmitted by specular surfaces
  GuideView<Real> guide;                  ///< what path guiding has learned; not part of the compiled scene
};

}  // namespace ALHAZEN_CORE

#pragma once

// The records of lights.

#include <cstdint>

#include "core/lights/light_list.h"
#include "core/lights/sphere_mapping.h"
#include "core/math/field_list.h"
#include "core/math/frame.h"
#include "core/math/vec.h"
#include "core/shapes/shape_records.h"
#include "core/textures/texture_record.h"

namespace ALHAZEN_CORE {

template <class Real>
struct LightRecord {
  LightKind kind;
  uint32_t primitive;   ///< shapes, environments, images: index into the array of that kind
  Vec3<Real> radiance;  ///< radiance; point and spot: intensity; distant: irradiance at normal incidence;
                        ///< environment: mean over all directions
  uint32_t two_sided;   ///< shapes: 1 if both sides emit
  uint32_t trail;       ///< position in the light tree: bit i selects the child at depth i
  Real pmf;  ///< probability that the light is chosen by power; if there is a light tree, among the lights at
             ///< infinity; 0 if only BSDF sampling finds the light
  Vec3<Real> position;
  Vec3<Real> direction;   ///< direction of propagation, unit length
  Vec2<Real> parameters;  ///< as the file of the kind says
  TextureRange texture;   ///< shapes: factor on the radiance
  uint32_t emitter;       ///< triangles: index into SceneView::triangle_emitters

  using Fields = FieldList<&LightRecord::kind, &LightRecord::primitive, &LightRecord::radiance, &LightRecord::two_sided,
                           &LightRecord::trail, &LightRecord::pmf, &LightRecord::position, &LightRecord::direction,
                           &LightRecord::parameters, &LightRecord::texture, &LightRecord::emitter>;
};

/// An emissive triangle without its texture: what sampling it needs, stored together.
template <class Real>
struct TriangleEmitter {
  Vec3<Real> corner[3];
  Vec3<Real> outward;  ///< mesh_outward
  uint32_t flip_normal;
  uint32_t two_sided;
  Vec3<Real> radiance;
  Vec3<Real> centre;           ///< mean of the corners
  Real near_distance_squared;  ///< from the centre: within it the triangle is sampled by solid angle

  /// What sampling by area or solid angle uses.
  using Fields = FieldList<&TriangleEmitter::corner, &TriangleEmitter::outward, &TriangleEmitter::flip_normal,
                           &TriangleEmitter::two_sided, &TriangleEmitter::radiance>;
};

/// A group of lights, or one of them: a sphere that bounds them, a cone that bounds their normals, and their power
/// (Estevez, Kulla 2018). Siblings are adjacent. The members are float in scenes of any precision.
struct LightTreeNode {
  Vec3<float> centre;
  float radius;
  Vec3<float> axis;
  float sin_normals, cos_normals;  ///< of the angle about the axis that bounds the normals
  float cos_emission;              ///< of the angle about a normal that bounds the emission, at most 90 degrees
  float power;
  uint32_t bits;  ///< index of the first child or of the light, times 4; and the two flags

  static constexpr uint32_t leaf = 1, two_sided = 2;
  ALHAZEN_HD bool is_leaf() const { return bits & leaf; }
  ALHAZEN_HD bool is_two_sided() const { return bits & two_sided; }
  ALHAZEN_HD uint32_t index() const { return bits >> 2; }
};
inline constexpr uint32_t max_light_tree_depth = 32;

/// The image of a delta light. Its texels are stored like an image's in texel_floats, linear.
template <class Real>
struct LightImageRecord {
  uint64_t first_texel;
  uint32_t width, height;
  Frame<Real> axes;  ///< goniometric: of the octahedral mapping; projection: right, up and direction of projection
  Real half_width, half_height;  ///< projection: of the image at distance 1
  Real unused;                   ///< padding, so that every byte of the record is defined
};

/// The texels of the map are stored like an image's in texel_floats, linear; its distributions are in environment_cdf:
/// those over the cells, for each group of normals, then those within each cell.
template <class Real>
struct EnvironmentRecord {
  uint64_t first_texel, first_cdf;
  uint32_t width, height;
  uint32_t cell_columns, cell_rows;
  SphereMapping mapping;
  uint32_t light;    ///< its index in `lights`
  Frame<Real> axes;  ///< x, y and z of the map in world space: orthonormal, of either handedness
  Vec3<Real> scale;  ///< factor on the texels
};

}  // namespace ALHAZEN_CORE

#pragma once

// How lights lie in memory.

#include <cstdint>

#include "core/lights/light_kind.h"
#include "core/lights/sphere_mapping.h"
#include "core/math/frame.h"
#include "core/math/vec.h"
#include "core/shapes/shape_records.h"
#include "core/textures/texture_record.h"

namespace ALHAZEN_CORE {

template <class Real>
struct LightRecord {
  LightKind kind;
  uint32_t primitive;   ///< shapes, environment, pictures: index into the array of that kind
  Vec3<Real> radiance;  ///< radiance; point and spot: intensity; distant: irradiance at normal incidence;
                        ///< environment: mean over all directions
  uint32_t two_sided;   ///< shapes: emits on both sides
  uint32_t trail;       ///< where it stands in the light tree: bit i says which child is its way at depth i
  Real pmf;             ///< probability that this light is chosen, by power where there is a light tree; 0: met by
                        ///< chance alone
  Vec3<Real> position;
  Vec3<Real> direction;       ///< the way the light travels, unit length
  Real cos_outer, cos_inner;  ///< spot: cosines where the light ends and where the falloff begins
  TextureRange texture;       ///< shapes: factor on the radiance
  uint32_t shining;           ///< triangles: index into SceneView::shining_triangles
};

/// A triangle that shines, without its texture: what sampling it needs, side by side.
template <class Real>
struct ShiningTriangle {
  Vec3<Real> corner[3];
  Vec3<Real> outward;  ///< mesh_outward
  uint32_t flip_normal;
  uint32_t two_sided;
  Vec3<Real> radiance;
};

/// A group of lights, or one of them, as seen from afar: a sphere that holds them, a cone that holds their normals,
/// what they emit (Estevez, Kulla 2018). Children lie side by side. In float whatever the precision of the scene.
struct LightTreeNode {
  Vec3<float> centre;
  float radius;
  Vec3<float> axis;
  float sin_normals, cos_normals;  ///< of the angle about the axis that holds the normals
  float cos_emission;              ///< of the angle about a normal that holds what is emitted, at most a right one
  float power;
  uint32_t bits;  ///< index of the first child or of the light, times 4; and the two flags

  static constexpr uint32_t leaf = 1, two_sided = 2;
  ALHAZEN_HD bool is_leaf() const { return bits & leaf; }
  ALHAZEN_HD bool is_two_sided() const { return bits & two_sided; }
  ALHAZEN_HD uint32_t index() const { return bits >> 2; }
};
inline constexpr uint32_t most_light_tree_depth = 32;

/// The picture of a light without size. Texels lie as an image's in texel_floats, linear.
template <class Real>
struct LightPictureRecord {
  uint64_t first_texel;
  uint32_t width, height;
  Frame<Real> axes;  ///< goniometric: of the octahedral mapping; projection: right, up and the way it is thrown
  Real half_width, half_height;  ///< projection: of the picture at distance 1
  Real unused;                   ///< so that no byte of the record is left undefined
};

/// A map's texels lie as an image's in texel_floats, linear. Its distribution lies in environment_cdf: height + 1
/// values over the rows, then width + 1 for each row.
template <class Real>
struct EnvironmentRecord {
  uint64_t first_texel, first_cdf;
  uint32_t width, height;
  SphereMapping mapping;
  uint32_t light;    ///< its index in `lights`
  Frame<Real> axes;  ///< x, y and z of the map in the world: orthonormal, of either handedness
  Vec3<Real> scale;  ///< factor on the texels
};

}  // namespace ALHAZEN_CORE

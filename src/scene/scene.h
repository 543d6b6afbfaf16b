#pragma once

// The scene description: the contents of a file, before they are validated, compiled and given a BVH. Colours are
// linear sRGB (D65). Lengths are in the scene's unit, angles in degrees, times in [0, 1] of the shutter unless said
// otherwise.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/cameras/camera_kind.h"
#include "core/integrators/integrator_kind.h"
#include "core/lights/light_list.h"
#include "core/materials/material_list.h"
#include "core/math/frame.h"
#include "core/math/vec.h"
#include "core/sampling/any_sampler.h"
#include "core/textures/mapping_kind.h"
#include "core/textures/texture_list.h"
#include "scene/transform.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

inline constexpr uint32_t no_index = 0xffffffffu;

/// Transforms at the start and at the end of the shutter interval.
struct MovingTransform {
  Transform start;
  Transform end;
  bool is_moving() const { return !(start == end); }
};

/// The texels of an image, rows from the top down.
struct ImageTexels {
  int width = 0, height = 0;
  /// `bytes` are sRGB-encoded or linear as `srgb` says; `floats` are linear.
  /// Exactly one of the two holds width * height * channels values.
  std::vector<uint8_t> bytes;
  std::vector<float> floats;
  bool srgb = true;
  std::string name;  ///< the file that it was read from
  int channels = 3;  ///< 3: red, green, blue; 1: a scalar, replicated to the three channels of textures
};

/// A texture is a node with other textures as inputs. A scalar texture has its value in all three channels.
struct Texture {
  std::string name;
  TextureKind kind = TextureKind::constant;
  /// constant: the value. threshold: the edge. Kinds whose file (core/textures/kinds) does not name other members:
  /// their numbers.
  Vec3d value{1, 1, 1};
  /// Inputs, indices into Scene::textures. checkerboard: even, odd. scale: factor, factor. mix: at 0, at 1, amount.
  /// dots: inside, outside. direction_mix: value where the normal is along `direction`, value where it is
  /// perpendicular.
  std::array<uint32_t, 3> inputs{no_index, no_index, no_index};
  /// 2D mapping: (s, t) = uv_scale * (u, v) + uv_offset, rotated by uv_rotation before the offset:
  /// s = c * us - r * vs + offset, t = r * us + c * vs + offset with c, r cosine and sine (counter-clockwise).
  Vec2d uv_scale{1, 1}, uv_offset{0, 0};
  double uv_rotation = 0;            ///< degrees
  int uv_set = 0;                    ///< 0: Mesh::uvs, 1: Mesh::second_uvs
  uint32_t image = no_index;         ///< image: index into Scene::images
  WrapMode wrap = WrapMode::repeat;  ///< along s
  std::optional<WrapMode> wrap_t;    ///< along t, if different
  int channel = 0;                   ///< channel: the channel of inputs[0]
  bool nearest = false;              ///< image: nearest texel instead of bilinear
  double image_scale = 1;            ///< image: factor on the value
  bool invert = false;               ///< image: 1 - value, after the factor
  bool solid_checks = false;         ///< checkerboard in 3D instead of over uv
  /// Solid textures (noise, solid checkerboard): from world space to texture space.
  Transform texture_from_world;
  int octaves = 8;         ///< fbm, wrinkled, marble
  double roughness = 0.5;  ///< fbm, wrinkled, marble: factor on the amplitude per octave
  double noise_scale = 1;  ///< marble: factor on the point
  double variation = 0.2;  ///< marble: distance by which noise displaces the veins
  /// image, checkerboard, coordinates, dots: the source of (s, t). planar: the first two rows of `texture_from_world`.
  TextureMappingKind mapping = TextureMappingKind::uv;
  Vec3d direction{0, 1, 0};  ///< direction_mix: unit length, world space
};

/// Inputs of the principled material, to which glTF's metallic-roughness model and its extensions are mapped. All are
/// textures; absent ones have the default given. Roughnesses are perceptual: alpha = roughness^2.
struct Principled {
  uint32_t base_colour = no_index;      ///< (1, 1, 1)
  uint32_t metallic = no_index;         ///< scalar, 0
  uint32_t roughness = no_index;        ///< scalar, 1
  uint32_t specular = no_index;         ///< scalar, 1: factor on the dielectric's reflection
  uint32_t specular_colour = no_index;  ///< (1, 1, 1): factor on it at normal incidence
  uint32_t transmission = no_index;     ///< scalar, 0: fraction of light not reflected by the base that is refracted
  uint32_t clearcoat = no_index;        ///< scalar, 0
  uint32_t clearcoat_roughness = no_index;    ///< scalar, 0
  uint32_t clearcoat_normal_map = no_index;   ///< as Material::normal_map
  uint32_t sheen_colour = no_index;           ///< (0, 0, 0)
  uint32_t sheen_roughness = no_index;        ///< scalar, 0
  uint32_t iridescence = no_index;            ///< scalar, 0
  uint32_t iridescence_thickness = no_index;  ///< scalar, nanometres, 400
  uint32_t anisotropy = no_index;             ///< scalar, 0: alpha along the tangent is lerp(alpha, 1, anisotropy^2)
  /// From the tangent counter-clockwise: (cos, sin) of an additional angle, encoded as 0.5 + 0.5 * x in red and green.
  uint32_t anisotropy_direction = no_index;
  double anisotropy_rotation = 0;  ///< degrees
  double iridescence_ior = 1.3;
  double clearcoat_normal_scale = 1;
  double ior = 1.5;
  double dispersion = 0;  ///< 20 / Abbe number
  /// Transmission without refraction: the surface is a thin sheet. Otherwise it bounds an absorbing volume.
  bool thin = true;
  /// Transmittance of white light over `attenuation_distance`, scene units; infinite: no absorption.
  Vec3d attenuation_colour{1, 1, 1};
  double attenuation_distance = std::numeric_limits<double>::infinity();
  /// scalar, 0: fraction of the light entering the diffuse base that leaves on the other side, diffusely.
  uint32_t diffuse_transmission = no_index;
  uint32_t diffuse_transmission_colour = no_index;  ///< (1, 1, 1)
};

/// A material of any kind. Members are of every kind unless they name those that they are of; coated_diffuse and
/// coated_conductor are a dielectric interface over what diffuse and conductor say.
struct Material {
  std::string name;
  MaterialKind kind = MaterialKind::diffuse;
  uint32_t reflectance = no_index;  ///< texture. diffuse; conductor if eta and k are not given
  uint32_t eta = no_index;          ///< texture. conductor: index of refraction relative to the outside
  uint32_t k = no_index;            ///< texture. conductor: absorption coefficient
  double ior = 1.5;                 ///< dielectric: index inside relative to outside
  uint32_t roughness_u = no_index;  ///< scalar textures, absent = smooth
  uint32_t roughness_v = no_index;
  bool remap_roughness = true;  ///< alpha = sqrt(roughness) as in pbrt-v4, instead of alpha = roughness
  Principled principled;        ///< principled
  /// Used by every kind of material. alpha: scalar texture, the opacity for stochastic transparency. normal_map:
  /// texture of normals in tangent space, encoded as 0.5 + 0.5 * n, z away from the surface.
  uint32_t alpha = no_index;
  uint32_t normal_map = no_index;
  double normal_scale = 1;            ///< factor on x and y of the normal map's normals
  bool double_sided = true;           ///< false: back faces are invisible to the camera
  uint32_t displacement = no_index;   ///< scalar texture, scene units along the normal: used as a bump map
  uint32_t transmittance = no_index;  ///< texture. diffuse_transmission
  std::array<uint32_t, 2> mixed{no_index, no_index};  ///< mix: indices into Scene::materials
  uint32_t amount = no_index;                         ///< mix: scalar texture, fraction of the second; absent: 0.5
  double coat_ior = 1.5;                              ///< coated_conductor
  uint32_t coat_roughness = no_index;                 ///< coated_conductor: scalar texture, absent = smooth
  double thickness = 0;            ///< coated kinds: optical thickness between the interface and the base
  Vec3d absorption{};              ///< dielectric: of its interior, per scene unit
  bool thickness_is_given = true;  ///< coated kinds: false if the file leaves it to the default
  int coat_bounces = 0;            ///< coated kinds: CoatModel::pbrt limits bounces at the base to this; 0: no limit
};

/// How much light pbrt's coated materials lose.
enum class CoatModel {
  lossless,  ///< only by the absorption that a file specifies, over diffuse bases
  pbrt       ///< also by the default thickness, at rough interfaces, and after Material::coat_bounces
};

/// A triangle mesh in object space, three indices per triangle. Normals and uvs are per vertex or absent (empty).
struct Mesh {
  std::vector<Vec3d> positions;
  std::vector<uint32_t> indices;
  std::vector<Vec3f> normals;
  std::vector<Vec2f> uvs;
  std::vector<Vec2f> second_uvs;
  /// Per vertex or absent: direction of increasing u, and 1 or -1, the handedness of (normal, tangent, bitangent).
  std::vector<std::array<float, 4>> tangents;
  std::vector<std::array<float, 4>> colours;  ///< linear red, green, blue and alpha, per vertex or absent
  std::string name;                           ///< the file that it was read from, for messages

  size_t triangle_count() const { return indices.size() / 3; }
};

/// Emission of a surface: radiance, W / (m^2 sr), on the side of the normal or on both.
struct Emission {
  Vec3d radiance;
  bool two_sided = false;
  uint32_t texture = no_index;  ///< factor on the radiance; absent: 1
};

enum class ShapeType { sphere, cylinder, disk, mesh };

struct Shape {
  std::string name;  ///< shapes of the same name are one object; empty: named by its kind
  ShapeType type = ShapeType::mesh;
  double radius = 1;             ///< sphere, centred at the origin of object space; cylinder and disk, about its z axis
  double inner_radius = 0;       ///< disk
  double z_min = -1, z_max = 1;  ///< cylinder: its ends; disk: both are its height
  double phi_max = 360;          ///< cylinder, disk: the azimuth from x, degrees
  uint32_t mesh = no_index;      ///< mesh: index into Scene::meshes
  MovingTransform world_from_object;
  uint32_t material = no_index;  ///< index into Scene::materials
  std::optional<Emission> emission;
  /// Flips normals and so also the emitting side. Without it the normal of a mesh follows the counter-clockwise winding
  /// in object space, that of a sphere or a cylinder points outward, and that of a disk along z.
  bool reverse_orientation = false;
  SourceLocation where;

  /// Half the size of a box about the origin of object space that holds the shape, if it is not a mesh.
  Vec3d reach() const {
    const double height = type == ShapeType::sphere ? radius : std::max(std::abs(z_min), std::abs(z_max));
    return {radius, radius, height};
  }
};

/// A group of shapes. Group 0 of a scene is the world itself; others are placed by instances.
struct ShapeGroup {
  std::string name;
  std::vector<Shape> shapes;  ///< in groups other than 0, `world_from_object` maps to the group's space
};

struct Instance {
  uint32_t group = no_index;
  MovingTransform world_from_group;
  bool reverse_orientation = false;  ///< of the instance itself, in addition to that of its shapes
  std::string name;                  ///< empty: that of its group, with a number
  SourceLocation where;
};

/// A light that is not a shape: of any kind but triangle, sphere and moving_sphere.
struct Light {
  std::string name;  ///< may be empty (scene/scene_names.h)
  LightKind kind = LightKind::constant_infinite;
  /// constant_infinite: radiance; environment: factor on the map; distant and sun: irradiance at normal incidence,
  /// W / m^2; others: intensity, W / sr.
  Vec3d radiance;
  Vec3d position;                                       ///< world space
  Vec3d direction{0, 0, 1};                             ///< world space, unit length, direction of propagation
  double cone_angle = 30;                               ///< spot, sun: degrees from the axis to the edge
  double falloff_start = 25;                            ///< spot: degrees from the axis to the start of the falloff
  uint32_t environment = no_index;                      ///< index into Scene::environments
  Frame<double> axes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  ///< environment: x, y, z of the map in world space, orthonormal
  SourceLocation where;
  uint32_t image = no_index;  ///< index into Scene::light_images
  double fov = 90;            ///< projection: degrees over the shorter side of the image
};

/// How `path` chooses one of several finite lights.
enum class LightSampling {
  automatic,  ///< by a light tree if there are more than a few
  power,      ///< by power alone
  tree,       ///< by a light tree
};

struct Camera {
  /// Camera space as in pbrt: x right, y up, z into the scene.
  MovingTransform world_from_camera;
  double fov = 90;  ///< perspective: degrees over the shorter axis of the image (of the screen window [-1, 1])
  /// x0, x1, y0, y1 on the plane at distance 1 / tan(fov / 2), of orthographic cameras in camera space; absent: [-1, 1]
  /// over the shorter axis.
  std::optional<std::array<double, 4>> screen_window;
  std::optional<double> frame_aspect_ratio;
  double lens_radius = 0;
  double focal_distance = 1e6;
  double shutter_open = 0, shutter_close = 1;
  CameraKind kind = CameraKind::perspective;
  bool is_default = false;  ///< the file has none; this one sees the whole scene (scene/default_view.h)
};

struct FilmSettings {
  int64_t width = 1280, height = 720;
  /// Pixels x0, x1, y0, y1 to render, half open; absent: all.
  std::optional<std::array<int64_t, 4>> pixel_bounds;
  std::string filename;  ///< as in the file, may be empty
  double exposure = 1;   ///< factor on the recorded radiance
  /// The lights have no definite brightness: 8-bit images may be darkened if they would be overexposed.
  bool fits_exposure = false;
};

enum class FilterType { box, triangle, gaussian, mitchell, sinc };

struct Filter {
  FilterType type = FilterType::gaussian;
  double x_radius = 1.5, y_radius = 1.5;  ///< pixels
  double sigma = 0.5;                     ///< gaussian
  double b = 1.0 / 3, c = 1.0 / 3;        ///< mitchell
  double tau = 3;                         ///< sinc
};

/// The whole description. A reader fills it; `compile` (compile/compile_scene.h) turns it into what integrators use.
struct Scene {
  std::string name;  ///< the file that it was read from
  Vec3d up{};        ///< the way up in world space, of any length; zero if the file does not say
  Camera camera;
  FilmSettings film;
  Filter filter;
  SamplerType sampler = SamplerType::sobol;
  int64_t samples_per_pixel = 16;
  std::string quality;  ///< by which to render where samples, noise and denoiser are left open; empty: none
  uint32_t seed = 0;
  IntegratorKind integrator = IntegratorKind::path;
  /// The integrator in the file if `path` replaces one that simulates more; else empty.
  std::string replaced_integrator;
  int64_t max_depth = 5;  ///< bounces, as pbrt counts them
  /// The interval over which motion is given; the camera's shutter is a part of it.
  double transform_start_time = 0, transform_end_time = 1;

  std::vector<ImageTexels> images;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Mesh> meshes;
  std::vector<ShapeGroup> groups{1};
  std::vector<Instance> instances;
  std::vector<Light> lights;
  /// Environment maps, of finite non-negative floats: square ones are equal-area octahedral, those twice as wide as
  /// high equirectangular (core/lights/sphere_mapping.h). Each belongs to one light.
  std::vector<ImageTexels> environments;
  /// Images of goniometric and projection lights, of finite non-negative floats, three per texel.
  std::vector<ImageTexels> light_images;
  LightSampling light_sampling = LightSampling::automatic;
  CoatModel coats = CoatModel::lossless;
};

}  // namespace alhazen::impl

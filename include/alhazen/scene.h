#pragma once

// A scene: made in memory from arrays, or read from a file, then looked at and changed, and rendered.
//
//   alhazen::Scene scene;
//   const auto clay = scene.add(alhazen::Principled{.base_colour = {0.8, 0.3, 0.2}});
//   const auto mesh = scene.add(alhazen::MeshArrays{.positions = positions, .indices = indices});
//   scene.add(alhazen::Shape{mesh, clay});
//   scene.look_at({0, 1, 3}, {0, 0, 0});
//   const alhazen::RenderedImage image = alhazen::render(scene);

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "alhazen/alhazen.h"
#include "alhazen/arrays.h"
#include "alhazen/camera.h"
#include "alhazen/error.h"
#include "alhazen/geometry.h"
#include "alhazen/handles.h"
#include "alhazen/lights.h"
#include "alhazen/materials.h"
#include "alhazen/shapes.h"
#include "alhazen/textures.h"
#include "alhazen/version.h"

namespace alhazen::impl {
struct SceneState;
}

namespace ALHAZEN_NAMESPACE {

/// How to read a scene file.
struct LoadOptions {
  std::string camera{};     ///< glTF: a name, or a number from 0; empty: the first
  std::string variant{};    ///< glTF: a name or a number of KHR_materials_variants; empty: none
  std::string animation{};  ///< glTF: a name or a number; empty: the first if `time` is given
  /// Seconds: the scene at this time of its animation (glTF) or motion (pbrt), when the shutter opens. Absent: no
  /// animation is applied, and the shutter opens when the scene says.
  std::optional<double> time{};
  /// Motion blur: the fraction of the time of a frame for which the shutter is open, 0 to 1. Absent: as the file says.
  std::optional<double> shutter{};
  double frames_per_second = 24;
  std::vector<std::string> definitions{};   ///< Mitsuba: NAME=VALUE for $NAME
  std::vector<std::string> search_paths{};  ///< folders in which files are looked for after the scene's own
  bool confine = false;                     ///< reads no files outside the folder of the scene file
  bool strict = false;                      ///< a texture image that is missing is an error
};

/// A scene of which renders, Renderers and RayQueries take copies. Copies are deep and share nothing; moving is cheap,
/// and a scene that was moved from can only be assigned to or destroyed. Functions that are const may be called from
/// several threads at once, also while others render the scene; while one thread calls any other function of it, no
/// other thread may use it. Different scenes, copies included, are independent.
///
/// A new scene has nothing in it. Until a camera is given, it is seen as a model is: from the front, the side and
/// above, whole, with y upwards. As long as it has no light at all, neither emissive shapes nor lights, it is lit by
/// neutral light from everywhere; set_environment(0) makes it dark instead. Both are as for a file that is a mesh
/// alone, and are decided when the scene is rendered. A scene that was read from a file has what the file says, and
/// what its reader adds.
///
/// All functions throw InputError, whose message names the argument, for a handle that is not of this scene, and for
/// values that are not finite or out of the range of their meaning; the scene is then unchanged. Those that copy, read
/// or take arrays and images throw OutOfMemoryError, after which the scene is unchanged, too.
class Scene {
 public:
  Scene();
  ~Scene();
  Scene(const Scene& other);
  Scene& operator=(const Scene& other);
  Scene(Scene&& other) noexcept;
  Scene& operator=(Scene&& other) noexcept;

  /// Reads a scene (.pbrt, .gltf, .glb, .xml of Mitsuba) or a model (.obj, .ply, .stl). Throws InputError with file,
  /// line and column, OutOfMemoryError, what `progress` throws, and Cancelled if it returns false.
  static Scene load(const std::string& file, const LoadOptions& options = {}, const ProgressFunction& progress = {});

  /// What the reader of the file warned of, each with its place.
  std::vector<Warning> warnings() const;
  std::string file() const;  ///< that it was read from; empty if it was not

  // Meshes. -----------------------------------------------------------------------------------------------------------

  MeshId add(const MeshArrays& arrays);
  MeshView mesh(MeshId mesh) const;
  void set_mesh(MeshId mesh, const MeshArrays& arrays);
  /// Moves the vertices, whose number stays. Without `normals` the mesh keeps those it has, which then may not fit.
  void set_positions(MeshId mesh, const Reals& positions, const Reals& normals = {});

  // Images and textures. ----------------------------------------------------------------------------------------------

  ImageId add(const Pixels& pixels);
  /// Reads PNG, JPEG, TGA, BMP, QOI, WebP, HDR, PFM or EXR. Without an encoding, that of the format: sRGB of 8 and 16
  /// bits, linear of floats. Linear is for data such as normals and roughness.
  ImageId load_image(const std::string& file, std::optional<Encoding> encoding = {});
  /// The same as one channel: alpha if there is one that is not 1 everywhere, else the mean of the colours.
  ImageId load_scalar_image(const std::string& file, std::optional<Encoding> encoding = {});
  Pixels image(ImageId image) const;  ///< a view into the scene
  void set_image(ImageId image, const Pixels& pixels);

  TextureId add(const Texture& texture);
  Texture texture(TextureId texture) const;
  /// A texture must not become an input of itself.
  void set(TextureId id, const Texture& texture);

  // Materials. --------------------------------------------------------------------------------------------------------

  MaterialId add(const Material& material);
  /// What a file says and the struct cannot is kept when the result, or a change of it, is set again.
  Material material(MaterialId material) const;
  void set(MaterialId id, const Material& material);

  // Shapes, groups and instances. -------------------------------------------------------------------------------------

  /// In the world, or in a group, where its transform is to the group's space. A sphere whose transform stretches it,
  /// and cylinders and disks that emit light or move, are rendered as meshes.
  ShapeId add(const Shape& shape, GroupId group = {});
  Shape shape(ShapeId shape) const;
  void set(ShapeId id, const Shape& shape);
  void set_transform(ShapeId shape, const MovingTransform& world_from_object);
  void set_material(ShapeId shape, MaterialId material);
  void remove(ShapeId shape);
  GroupId group_of(ShapeId shape) const;  ///< none: it is in the world

  /// A group without shapes: add them to it, then add instances of it.
  GroupId add_group(const std::string& name = {});
  InstanceId add(const Instance& instance);
  Instance instance(InstanceId instance) const;
  void set(InstanceId id, const Instance& instance);
  void set_transform(InstanceId instance, const MovingTransform& world_from_group);
  void remove(InstanceId instance);

  // Lights. -----------------------------------------------------------------------------------------------------------

  /// `image` is for goniometric (square), projection and environment lights alone, and must be given for them; bytes
  /// are decoded, and negative values are 0.
  LightId add(const Light& light, const Pixels& image = {});
  Light light(LightId light) const;
  Pixels light_image(LightId light) const;  ///< a view into the scene; empty if the light has none
  /// Keeps the image of a light that has one and stays of its kind.
  void set(LightId id, const Light& light, const Pixels& image = {});
  void remove(LightId light);

  /// These replace all infinite lights: by light of one colour (W / (m^2 sr)), by an image, or by one from a file. The
  /// top of the image is towards +y, its centre towards -z.
  LightId set_environment(const Colour& radiance);
  LightId set_environment(const Pixels& image);
  LightId load_environment(const std::string& file);

  // Camera and film. --------------------------------------------------------------------------------------------------

  /// That of the scene; without one, that which sees the whole scene as it is now.
  Camera camera() const;
  void set_camera(const Camera& camera);
  /// These place the camera, keep all else of it, and focus it on what it is placed for if its lens has a radius. They
  /// also keep the handedness of the scene: new ones are right-handed, those from pbrt files left-handed.
  /// Without `up` the scene's axis that was upwards stays so.
  void look_at(const Vec3& eye, const Vec3& target, const std::optional<Vec3>& up = {});
  /// Turns it about the middle of the scene: azimuth from the front and elevation in degrees. Without a distance all of
  /// the scene is seen. Surroundings far larger than the rest, such as a ground, do not count.
  void orbit(double azimuth, double elevation, std::optional<double> distance = {});
  /// Moves it so that it sees the whole scene in the direction in which it looks.
  void fit();
  Vec3 up() const;              ///< the direction upwards in world space; 0, 0, 0: the file does not say
  void set_up(const Vec3& up);  ///< for look_at, orbit and the default view

  /// Sides must be from 1 to 100000 pixels; each is what it is set to, whatever the other is.
  Film film() const;
  void set_film(const Film& film);
  PixelFilter pixel_filter() const;
  void set_pixel_filter(const PixelFilter& filter);
  RenderDefaults render_defaults() const;
  void set_render_defaults(const RenderDefaults& defaults);

  // What is in it. ----------------------------------------------------------------------------------------------------

  std::vector<MeshId> meshes() const;
  std::vector<ImageId> images() const;
  std::vector<TextureId> textures() const;  ///< without the constants that are inputs of others
  std::vector<MaterialId> materials() const;
  std::vector<ShapeId> shapes() const;  ///< of the world, then of the groups
  /// Of a group, or with GroupId() of the world, in the order in which ray queries count them (HitArrays::shapes).
  std::vector<ShapeId> shapes(GroupId group) const;
  std::vector<GroupId> groups() const;
  std::vector<InstanceId> instances() const;
  std::vector<LightId> lights() const;

  /// Names as in layers and reports: parts without one are called by their kind and a number.
  std::string name(MaterialId material) const;
  std::string name(ShapeId shape) const;
  std::string name(InstanceId instance) const;
  std::string name(LightId light) const;
  /// These are as they were given; of files, mostly the file's.
  std::string name(MeshId mesh) const;
  std::string name(ImageId image) const;
  std::string name(TextureId texture) const;
  std::string name(GroupId group) const;

  /// The first of that name; none if there is none.
  MaterialId find_material(const std::string& name) const;
  TextureId find_texture(const std::string& name) const;
  MeshId find_mesh(const std::string& name) const;
  ImageId find_image(const std::string& name) const;
  GroupId find_group(const std::string& name) const;
  /// All of that name.
  std::vector<ShapeId> find_shapes(const std::string& name) const;
  std::vector<InstanceId> find_instances(const std::string& name) const;
  std::vector<LightId> find_lights(const std::string& name) const;

  /// World space, of all shapes and instances when the shutter opens; empty if there are none.
  Box bounds() const;

  /// For the library itself; programs cannot use what they return.
  const impl::SceneState& state() const;
  impl::SceneState& state();

 private:
  explicit Scene(std::unique_ptr<impl::SceneState> state);

  std::unique_ptr<impl::SceneState> state_;
};

/// Renders a copy of the scene as render(file) does its file; a scene that was read and not changed gives the same
/// image. Settings about reading (camera, variant, animation, animation_time, shutter, definitions) must be empty: they
/// are LoadOptions here. Throws as render(file) does.
RenderedImage render(const Scene& scene, const Settings& settings = {}, const ProgressFunction& progress = {});

}  // namespace ALHAZEN_NAMESPACE

#pragma once

// The state of the reader while it processes a scene file: the scene so far, the graphics state of the format, and the
// named entities. The directives are functions over it, with one file for each topic.

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "colour/spectrum.h"
#include "files/input_file.h"
#include "io/find_file.h"
#include "io/pbrt/parameters.h"
#include "scene/scene.h"

namespace alhazen::impl::pbrt {

/// The emission that AreaLightSource gives to subsequent shapes.
struct AreaLight {
  Vec3d radiance;
  bool two_sided = false;
  double power = 0;  ///< watts of the whole shape; if over 0, scales `radiance` by the area of each
  Place place;
  uint32_t texture = no_index;  ///< of its image
  double image_mean = 1;        ///< mean luminance of the image
};

/// A material as used by a shape: with its alpha, and with the absorption of the medium inside.
struct MaterialVariant {
  uint32_t base = no_index;
  uint32_t alpha = no_index;
  Vec3d absorption{};
  Place medium_place;  ///< location of the shape that needs it
};

/// The directives that `Attribute` sets defaults for.
struct AttributeDefaults {
  InheritedParameters shape, light, material, medium, texture;
};

/// The state that AttributeBegin saves and AttributeEnd restores.
struct GraphicsState {
  Transform ctm_start, ctm_end;
  bool start_active = true, end_active = true;  ///< which of the two the transform directives change
  bool reverse_orientation = false;
  uint32_t material = no_index;  ///< absent: the default material
  std::optional<AreaLight> area_light;
  Vec3d absorption_inside{};  ///< of the medium that MediumInterface sets for the inside of shapes
  std::string rgb_space = "srgb";
  AttributeDefaults defaults;

  MovingTransform ctm() const { return {ctm_start, ctm_end}; }
};

/// The cost of evaluating a texture with all its inputs.
struct TextureSize {
  uint32_t levels = 1;  ///< nesting depth of textures
  uint32_t stack = 1;   ///< depth of the evaluation stack
  uint64_t nodes = 1;   ///< number of nodes; a texture that is used twice counts twice
};

/// A material or object that is referred to by name, perhaps before it is defined.
struct NamedEntry {
  uint32_t index = no_index;
  bool defined = false;
  Place first_use;  ///< location for the error if no definition follows
};

struct Build {
  Build(std::string folder_, InputScope scope_, Diagnostics& diagnostics_);

  Scene scene;
  Diagnostics& diagnostics;
  /// Of the last LookAt: its way up, and the transform after it.
  Vec3d look_at_up{};
  Transform after_look_at;
  std::string folder;  ///< relative paths are resolved from here
  InputScope scope;    ///< of all files that the scene refers to
  FileSearch search;

  GraphicsState state;
  bool in_world = false;
  std::map<std::string, MovingTransform> coordinate_systems;
  uint32_t open_object = 0;  ///< index of the group between ObjectBegin and ObjectEnd, else 0

  std::map<std::string, NamedEntry> materials;
  std::map<std::string, NamedEntry> objects;
  std::map<std::string, uint32_t> float_textures, spectrum_textures;
  std::vector<TextureSize> texture_sizes;   ///< of the first textures of the scene
  std::vector<bool> material_is_invisible;  ///< by material: its surfaces are omitted
  uint32_t default_material = no_index;
  std::map<std::string, Vec3d> absorbing_media;  ///< homogeneous ones without scattering: absorption per unit
  std::map<uint32_t, MaterialVariant> variants;  ///< by material; filled in at the end, when all are defined
  std::map<std::tuple<uint32_t, uint32_t, std::array<double, 3>>, uint32_t> variants_by_key;
  std::map<uint32_t, Place> mix_places;  ///< by material

  /// Meshes and images that are read or made only once, keyed by file or by their parameters.
  std::map<std::string, uint32_t> meshes_by_key;
  std::map<std::tuple<std::string, int, bool>, uint32_t> images_by_key;
  std::map<std::array<double, 3>, uint32_t> constants;
  mutable std::map<std::string, Spectrum> spectra_by_file;
  std::map<std::string, double> image_means;  ///< mean luminance of an area light's image, by file

  double iso = 100;
  std::optional<double> exposure_time;  ///< seconds; absent: for as long as the shutter is open
  double film_diagonal = 35;            ///< millimetres
  /// For a realistic camera: the distance from lens to film in millimetres, which determines its field of view.
  std::optional<double> lens_image_distance;
  double lens_exposure = 1;  ///< factor of the lens on the exposure: the solid angle of its opening

  void warn(const Place& place, const std::string& message) { diagnostics.warn(place.location(), message); }
  /// Warns that `directive` is not supported; `instead` says what the reader does instead.
  void warn_replaced(const ParameterList& list, const std::string& instead);

  /// The file `name`, in the scene's folder or one of `search`. Throws, with the location `place`, if it cannot be
  /// read.
  InputPath existing_file(const Place& place, const std::string& name) const;

  /// The same for an image of a texture. If there is no such file, and that is no error, warns that it is replaced as
  /// `instead` says, and returns nothing.
  std::optional<InputPath> existing_image(const Place& place, const std::string& name, const std::string& instead);

  /// A texture with a constant value.
  uint32_t constant_texture(const Vec3d& value);

  NamedEntry& named_material(const std::string& name, const Place& place);
  NamedEntry& named_object(const std::string& name, const Place& place);

  std::vector<Shape>& shapes() { return scene.groups[open_object].shapes; }

  /// Resolves what is known only at the end of the file: forward references, invisible surfaces, exposure.
  Scene finish();
};

}  // namespace alhazen::impl::pbrt

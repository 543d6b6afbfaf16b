#pragma once

// What the reader carries along while it goes through a scene file: the scene so far, the graphics state of the
// format, and what has a name. The directives are functions over it, a file for each topic.

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
#include "io/pbrt/parameters.h"
#include "scene/scene.h"

namespace alhazen::pbrt {

/// The emission that AreaLightSource gives to the shapes that follow.
struct AreaLight {
  Vec3d radiance;
  bool two_sided = false;
  double power = 0;  ///< watts of the whole shape, where over 0: scales `radiance` by the area of each
  Place place;
  uint32_t texture = no_index;  ///< of its picture
  double picture_mean = 1;      ///< luminance, over all of the picture
};

/// A material as a shape has it: with its alpha, and with what the medium inside absorbs.
struct MaterialVariant {
  uint32_t base = no_index;
  uint32_t alpha = no_index;
  Vec3d absorption{};
  Place medium_place;  ///< where the shape is that asks for it
};

/// The directives that `Attribute` sets defaults for.
struct AttributeDefaults {
  InheritedParameters shape, light, material, medium, texture;
};

/// What AttributeBegin saves and AttributeEnd brings back.
struct GraphicsState {
  Transform ctm_start, ctm_end;
  bool start_active = true, end_active = true;  ///< which of the two the transform directives change
  bool reverse_orientation = false;
  uint32_t material = no_index;  ///< absent: the default material
  std::optional<AreaLight> area_light;
  Vec3d absorption_inside{};  ///< of the medium that MediumInterface gives to the inside of shapes
  std::string rgb_space = "srgb";
  AttributeDefaults defaults;

  MovingTransform ctm() const { return {ctm_start, ctm_end}; }
};

/// What it takes to evaluate a texture with all that it is made of.
struct TextureSize {
  uint32_t levels = 1;  ///< textures within each other
  uint32_t stack = 1;   ///< values that wait for each other
  uint64_t nodes = 1;   ///< a texture that is used twice counts twice
};

/// A material or object that is referred to by name, perhaps before it is defined.
struct NamedEntry {
  uint32_t index = no_index;
  bool defined = false;
  Place first_use;  ///< where it is told that no definition comes
};

struct Build {
  Build(std::string folder_, InputScope scope_, Diagnostics& diagnostics_);

  Scene scene;
  Diagnostics& diagnostics;
  std::string folder;  ///< relative paths start here
  InputScope scope;    ///< of all files that the scene names

  GraphicsState state;
  bool in_world = false;
  std::map<std::string, MovingTransform> coordinate_systems;
  uint32_t open_object = 0;  ///< index of the group between ObjectBegin and ObjectEnd, else 0

  std::map<std::string, NamedEntry> materials;
  std::map<std::string, NamedEntry> objects;
  std::map<std::string, uint32_t> float_textures, spectrum_textures;
  std::vector<TextureSize> texture_sizes;   ///< of the first textures of the scene
  std::vector<bool> material_is_invisible;  ///< by material: the surface is left out
  uint32_t default_material = no_index;
  std::map<std::string, Vec3d> absorbing_media;  ///< homogeneous and without scattering: absorption per unit
  std::map<uint32_t, MaterialVariant> variants;  ///< by material; filled in at the end, when all are defined
  std::map<std::tuple<uint32_t, uint32_t, std::array<double, 3>>, uint32_t> variants_by_key;
  std::map<uint32_t, Place> mix_places;  ///< by material

  /// Meshes and images that are read or made once: by file or by the numbers that make them.
  std::map<std::string, uint32_t> meshes_by_key;
  std::map<std::tuple<std::string, int, bool>, uint32_t> images_by_key;
  std::map<std::array<double, 3>, uint32_t> constants;
  mutable std::map<std::string, Spectrum> spectra_by_file;
  std::map<std::string, double> picture_means;  ///< luminance over all of an area light's picture, by file

  double iso = 100;
  std::optional<double> exposure_time;  ///< seconds; absent: as long as the shutter is open
  double film_diagonal = 35;            ///< millimetres
  /// Of a realistic camera: from its lens to the film, millimetres. Its field of view follows from the film.
  std::optional<double> lens_image_distance;
  double lens_exposure = 1;  ///< what the lens lets onto the film: the solid angle of its opening

  void warn(const Place& place, const std::string& message) { diagnostics.warn(place.location(), message); }
  /// `directive` is not done by this reader; `instead` says what it does.
  void warn_replaced(const ParameterList& list, const std::string& instead);

  /// The file `name`, relative to the scene's folder. Throws at `place` where it cannot be read.
  InputPath existing_file(const Place& place, const std::string& name) const;

  /// The texture that is `value` everywhere.
  uint32_t constant_texture(const Vec3d& value);

  NamedEntry& named_material(const std::string& name, const Place& place);
  NamedEntry& named_object(const std::string& name, const Place& place);

  std::vector<Shape>& shapes() { return scene.groups[open_object].shapes; }

  /// Settles what is known only at the end of the file: forward references, invisible surfaces, exposure.
  Scene finish();
};

}  // namespace alhazen::pbrt

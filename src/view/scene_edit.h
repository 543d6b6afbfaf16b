#pragma once

// What viewers ask of a scene beside its image: what is under a pixel, and other values for its materials.
//
// Costs: the first pick, and the first after a change of shapes or where they are, builds a BVH of the whole scene; all
// others trace one ray. Fields are read and set without building anything: the next Renderer::start does.

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "alhazen/rays.h"
#include "alhazen/scene.h"

namespace alhazen::impl {

/// What the camera sees in the middle of a pixel.
struct PickedPoint {
  ShapeId shape;
  InstanceId instance;               ///< none: the shape is in the world
  MaterialId material;               ///< none: the shape has none
  std::string object;                ///< name of the shape
  std::string instance_name;         ///< empty if there is none
  std::string where;                 ///< `file:line` of the shape; empty if it is unknown
  ::alhazen::Vec3 position, normal;  ///< world space; the normal is geometric, of unit length, towards the camera
  /// Along the viewing direction of perspective and orthographic cameras, in camera space, as Camera::focal_distance;
  /// of others from the camera, in world space.
  double distance = 0;
};

/// Finds what is under pixels, by a BVH of its own, since that of a renderer may be on a GPU. It sees surfaces as the
/// camera does: those whose material cuts them out are passed through where their opacity is under a half, if it is a
/// number or an image. Used by one thread.
class Picker {
 public:
  /// Builds the BVH if geometry or transforms have changed since the last time. The camera is that of the scene, for an
  /// image of that size; motion is as when the shutter opens. Nothing where it sees no surface. Throws InputError for
  /// a pixel outside the image, and what RayQueries throw: Cancelled if `building` returns false.
  std::optional<PickedPoint> pick(const ::alhazen::Scene& scene, int width, int height, int x, int y,
                                  const ProgressFunction& building = {});

 private:
  struct Built {
    uint32_t scene = 0;
    uint64_t geometry = 0, transforms = 0;
    friend bool operator==(const Built&, const Built&) = default;
  };

  std::optional<RayQueries> queries_;
  Built built_;
};

/// The ray through the middle of a pixel, from the middle of the lens.
struct PixelRay {
  ::alhazen::Vec3 origin, direction;  ///< world space; the direction of any length
  double distance_per_t = 1;          ///< PickedPoint::distance at origin + t * direction
};
PixelRay pixel_ray(const ::alhazen::Camera& camera, int width, int height, double x, double y);

using FieldValue = std::variant<double, bool, std::array<double, 3>>;

/// A number, a colour or a flag of a material.
struct MaterialField {
  std::string name;   ///< of the member in include/alhazen/materials.h: "roughness", "coat_roughness"
  std::string label;  ///< for people: "coat roughness"
  FieldValue value;   ///< of textured fields 0
  bool is_textured = false;
  double min = 0, max = 1;  ///< for sliders; values that the material takes may go beyond `max`
};

/// "Principled"
std::string material_kind(const ::alhazen::Material& material);

/// Those that can be set. A roughness that differs along u and v is two fields, roughness_u and roughness_v.
std::vector<MaterialField> material_fields(const ::alhazen::Material& material);

/// Sets fields, and replaces their textures; the scene is unchanged if one of them is refused. Throws InputError that
/// names the field.
void set_material_fields(::alhazen::Scene& scene, MaterialId material, const std::map<std::string, FieldValue>& values);

/// What was changed of materials, from what they were at first.
class MaterialChanges {
 public:
  /// Remembers what a material is, unless an earlier state of it is known. Call it before each change.
  void remember(const ::alhazen::Scene& scene, MaterialId material);
  /// "material 'gold': roughness 0.1 -> 0.3", one for each field that differs.
  std::vector<std::string> lines(const ::alhazen::Scene& scene) const;
  /// Does the same to the materials of those names in a scene that was read anew, and is about that scene from now on.
  /// Returns a line for each that has become impossible.
  std::vector<std::string> repeat(const ::alhazen::Scene& before, ::alhazen::Scene& scene);

 private:
  std::map<MaterialId, std::vector<MaterialField>> first_;
};

}  // namespace alhazen::impl

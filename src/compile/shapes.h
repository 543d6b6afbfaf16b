#pragma once

// The part of compiling that makes the records of shapes: primitives, vertices, surfaces, and the lights of shapes that
// emit.

#include <cstdint>
#include <vector>

#include "compile/instances.h"
#include "compile/materials.h"
#include "compile/scene_arrays.h"
#include "scene/scene.h"
#include "scene/scene_names.h"

namespace alhazen::impl {

/// Sizes of all meshes that are placed, each as often as it is placed.
struct MeshSizes {
  uint64_t triangles = 0, vertices = 0, normals = 0, uvs = 0;
};

/// The record of a light of a shape that emits, without its kind and primitive. Throws InputError if its radiance is
/// not finite in this precision.
template <class Real>
LightRecord<Real> shape_light(const Shape& shape, const Scene& scene, const CompiledMaterials& materials);

/// Places shapes. Every placement is counted first, so that arrays grow once and a mesh is freed after its last use.
template <class Real>
class ShapeBuilder {
 public:
  /// `light_measures`, by light: see assign_light_probabilities. With `names`, surfaces get ids. With `origins`, which
  /// gets those of surfaces, triangles get theirs, and all spheres uvs. All references must outlive the builder.
  ShapeBuilder(Scene& scene, const CompiledMaterials& materials, SceneArrays<Real>& out,
               std::vector<double>& light_measures, Diagnostics& diagnostics, SceneNames* names = nullptr,
               std::vector<ShapeOrigin>* origins = nullptr);

  /// Counts the uses and sizes of the meshes of `placements`. Throws InputError for shapes that name no mesh.
  void count(const std::vector<ShapePlacement>& placements);

  const MeshSizes& sizes() const { return sizes_; }

  /// Reserves memory for what was counted.
  void reserve();

  /// Appends the records of a shape to the arrays. A shape that is smaller than this precision resolves is left out
  /// with a warning. Throws InputError for shapes that cannot be rendered: sizes that are not positive, indices out of
  /// range, coordinates that are not finite or overflow in this precision.
  void place(const ShapePlacement& placement);

  /// Warns once of all triangles that were left out because they have no area.
  void warn_of_dropped_triangles() const;

  /// The location of the shape that has a surface, by index into `surfaces`; that of the scene for copies of surfaces,
  /// which follow all others (compile/open_backs.h).
  SourceLocation location_of(uint32_t surface) const {
    return surface < surface_shapes_.size() ? surface_shapes_[surface]->where : SourceLocation{scene_.name};
  }

  /// The ids of the objects that the lights of shapes belong to, if there are names.
  const std::vector<uint32_t>& light_objects() const { return light_objects_; }
  /// Those of shapes that are to emit, also where nothing of them could be placed.
  const std::vector<uint32_t>& emissive_objects() const { return emissive_objects_; }

 private:
  void place_sphere(const ShapePlacement& p);
  template <class Record>
  void place_quadric(const ShapePlacement& p, Record (*record_of)(const Shape&, const Transform&),
                     std::vector<Record>& records);
  void place_mesh(const ShapePlacement& p, const Mesh& mesh);
  uint32_t add_attributes(const ShapePlacement& p, const Mesh& mesh, uint32_t base);
  void add_triangles(const Shape& shape, const Mesh& mesh, uint32_t base, uint32_t normal_offset, uint32_t uv_offset,
                     bool flip, uint32_t attributes);
  uint32_t add_surface(const Shape& shape, uint32_t light, uint32_t normal_offset, uint32_t uv_offset, bool flip,
                       uint32_t attributes = no_offset);
  uint32_t add_light(const Shape& shape, LightKind kind, size_t primitive, double area);
  uint32_t add_sphere_frame(const Shape& shape, const Transform& world_from_object);
  bool needs_uv(const Shape& shape) const;

  Scene& scene_;
  const CompiledMaterials& materials_;
  SceneArrays<Real>& out_;
  std::vector<double>& light_measures_;
  Diagnostics& diagnostics_;
  SceneNames* names_;
  std::vector<ShapeOrigin>* origins_;
  ShapeOrigin origin_;          ///< of what is being placed
  uint32_t object_id_ = no_id;  ///< of what is being placed
  MeshSizes sizes_;
  std::vector<uint32_t> uses_;                ///< by mesh: placements still to come
  std::vector<const Shape*> surface_shapes_;  ///< by surface
  std::vector<uint32_t> light_objects_, emissive_objects_;
  size_t without_area_ = 0;            ///< number of triangles that were left out
  SourceLocation without_area_place_;  ///< of the first of them
};

}  // namespace alhazen::impl

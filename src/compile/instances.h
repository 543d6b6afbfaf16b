#pragma once

// The part of compiling that places groups of shapes: a group becomes an object, which instances refer to, or its
// shapes are copied into the world.

#include <cstdint>
#include <vector>

#include "compile/scene_arrays.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// A shape with its final placement: its own transform, or an instance's applied to it.
struct ShapePlacement {
  const Shape* shape;
  MovingTransform world_from_object;
  bool reverse_orientation;
  ShapeOrigin origin;
  const Instance* instance = nullptr;  ///< whose transform was applied, if any
};

/// Where shapes and instances were described, before group_moving_meshes.
struct DescribedIndices {
  std::vector<std::vector<uint32_t>> shapes;  ///< by group and shape: its index in the group that it was described in
  std::vector<uint32_t> instances;  ///< by instance: its index; no_index for one that places a moving mesh of the world
};

/// Returns whether a shape is a light.
bool emits(const Shape& shape);

/// The mesh of a shape of type mesh. Throws InputError if there is none.
const Mesh& mesh_of(const Scene& scene, const Shape& shape);

/// The fraction of its motion that a transform has completed at `time`, in [0, 1]; 0 for one that does not move.
double fraction_of_motion(const Scene& scene, const MovingTransform& transform, double time);

/// Turns moving meshes into groups of their own, with one instance for those in the world, and one for each instance
/// of the object that contains them. Those that emit remain where they are.
DescribedIndices group_moving_meshes(Scene& scene);

/// Selects the groups that become objects: those that move, and those with several instances, unless all copies
/// together have at most `max_copied_triangles`. `triangle_counts` are those of the meshes. Throws InputError for
/// instances of no group and shapes of no mesh.
std::vector<bool> find_objects(const Scene& scene, const std::vector<uint64_t>& triangle_counts,
                               uint64_t max_copied_triangles);

/// By mesh.
std::vector<uint64_t> triangle_counts(const Scene& scene);

/// The shapes of the world, and copies of all that no object contains: groups that are no objects, and the lights,
/// spheres, cylinders and disks of the others. `is_object` is what find_objects returns.
std::vector<ShapePlacement> world_placements(const Scene& scene, const std::vector<bool>& is_object,
                                             const DescribedIndices& described);

/// The shapes of every object, by group, in the space of the group; empty for groups that are no objects.
std::vector<std::vector<ShapePlacement>> object_placements(const Scene& scene, const std::vector<bool>& is_object,
                                                           const DescribedIndices& described);

/// Appends the record of an instance of the object with index `object`, and its motion while the shutter is open. Its
/// object id remains unset.
/// Throws InputError if its transform is not finite, or maps the object to a plane.
template <class Real>
void add_instance(const Scene& scene, const Instance& instance, uint32_t object, SceneArrays<Real>& out);

}  // namespace alhazen::impl

#pragma once

// The names by which layers and reports tell objects, materials and lights apart, and the ids of the first two in the
// compiled scene.

#include <cstdint>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "scene/scene.h"

namespace alhazen::impl {

/// Names with their ids, which count from 1. The same name has the same id.
class NameTable {
 public:
  uint32_t id_of(const std::string& name);
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::unordered_map<std::string, uint32_t> ids_;
  std::vector<std::string> names_;  ///< by id - 1
};

/// Makes names of a kind and a number, counted from 1: `sphere.1`. Names that were given are left out.
class NumberedNames {
 public:
  /// `name` was given to a part, or is to be left out for another reason.
  void take(const std::string& name);
  std::string next(const std::string& kind);

 private:
  std::unordered_set<std::string> taken_;  ///< those that end in a digit
  std::unordered_map<std::string, uint32_t> counts_;
};

/// The names of Scene::instances, in their order: given, or for instances of named groups that of the group with a
/// number, `tree.1`; else empty.
std::vector<std::string> instance_names(const Scene& scene);

/// The names of Scene::materials, in their order. Those without are called by their number, `material.3`, or if
/// another has that name by one beyond the number of materials.
std::vector<std::string> material_names(const Scene& scene);

/// Gives instances of named groups their names, with numbers: `tree.1`. Before moving meshes get groups of their own,
/// whose instances keep them; where there are such, it names the shapes too.
void name_instances(Scene& scene);

/// Gives all shapes that are in no group the names that SceneNames makes: before what they are counted by changes.
void name_world_shapes(Scene& scene);

/// Of Scene::lights, in their order. All that surrounds the scene, whether an image or of one colour, is called
/// `environment`. What a file leaves without a name is called by its kind and a number that no part has: `point.1`.
std::vector<std::string> light_names(const Scene& scene);

/// Names the objects and materials of a scene. What a file leaves without a name is called by its kind and a number,
/// counted among those without names: `sphere.1`. Numbers are left out where a part was given that name. An instance is
/// one object (name_instances).
class SceneNames {
 public:
  explicit SceneNames(const Scene& scene);

  /// `instance`, if not null, is what places the shape.
  uint32_t object_id(const Shape& shape, const Instance* instance = nullptr);
  uint32_t object_id(const Instance& instance);
  /// Of an instance of that name, one of instance_names.
  uint32_t new_object_id(const std::string& instance_name);
  /// `material` is an index into Scene::materials, or no_index.
  uint32_t material_id(uint32_t material);

  const std::vector<std::string>& objects() const { return objects_.names(); }
  const std::vector<std::string>& materials() const { return materials_.names(); }

 private:
  const Scene& scene_;
  void find_taken();

  NameTable objects_, materials_;
  bool has_taken_ = false;  ///< `numbered_` knows the names that were given
  NumberedNames numbered_;
  std::vector<std::string> of_materials_;  ///< by index; empty until they are needed
  std::string of_no_material_;
  std::unordered_map<const void*, uint32_t> object_ids_;  ///< of shapes and instances
};

}  // namespace alhazen::impl

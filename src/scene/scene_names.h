#pragma once

// The names by which layers and reports tell objects, materials and lights apart, and the ids of the first two in the
// compiled scene.

#include <cstdint>
#include <string>
#include <unordered_map>
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

/// Gives instances of named groups their names, with numbers: `tree.1`. Before moving meshes get groups of their own,
/// whose instances keep them.
void name_instances(Scene& scene);

/// Of Scene::lights, in their order. All that surrounds the scene, whether an image or of one colour, is called
/// `environment`. What a file leaves without a name is called by its kind and a number: `point.1`.
std::vector<std::string> light_names(const Scene& scene);

/// Names the objects and materials of a scene. What a file leaves without a name is called by its kind and a number,
/// counted among those without names: `sphere.1`. An instance is one object (name_instances).
class SceneNames {
 public:
  explicit SceneNames(const Scene& scene);

  /// `instance`, if not null, is what places the shape.
  uint32_t object_id(const Shape& shape, const Instance* instance = nullptr);
  uint32_t object_id(const Instance& instance);
  /// `material` is an index into Scene::materials, or no_index.
  uint32_t material_id(uint32_t material);

  const std::vector<std::string>& objects() const { return objects_.names(); }
  const std::vector<std::string>& materials() const { return materials_.names(); }

 private:
  const Scene& scene_;
  NameTable objects_, materials_;
  std::unordered_map<const void*, uint32_t> object_ids_;  ///< of shapes and instances
  std::unordered_map<std::string, uint32_t> counts_;      ///< of names that have been numbered
};

}  // namespace alhazen::impl

#pragma once

// The names of a scene's parts, kept until a change may have changed them.

#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

namespace alhazen::impl {

struct SceneState;

/// Names by the indices of handles, empty for parts that were removed, and the reverse.
struct PartNames {
  using Indices = std::unordered_map<std::string, std::vector<uint32_t>>;

  std::vector<std::string> shapes, instances, materials, lights;
  Indices shapes_of, instances_of, materials_of, lights_of;
  uint64_t geometry = 0, of_materials = 0, of_lights = 0, environment = 0;  ///< revisions
};

/// Of one scene. Several threads may ask at once, as long as none changes the scene.
class PartNameCache {
 public:
  std::shared_ptr<const PartNames> of(const SceneState& state) const;

 private:
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const PartNames> names_;
};

}  // namespace alhazen::impl

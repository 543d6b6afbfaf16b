#pragma once

// The compiled scene in memory: one arena with every array, and the view of it.

#include <array>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "compile/scene_origins.h"
#include "core/scene_view.h"

namespace alhazen::impl {

struct FreeArena {
  void operator()(std::byte* memory) const { std::free(memory); }
};

/// The number of primitives of a kind, and what reports call them.
struct PrimitiveCount {
  const char* name;
  uint64_t count;
};

/// Sizes and times of a compiled scene, for reports. Moving spheres count as spheres.
struct SceneStatistics {
  uint64_t triangles = 0, spheres = 0, nodes = 0, lights = 0, instances = 0;
  std::vector<PrimitiveCount> others;  ///< kinds other than triangles and spheres, also those of which there are none
  uint64_t bytes = 0;                  ///< of the arena
  uint64_t tree_bytes = 0;             ///< of the acceleration structures: nodes, and their copies of primitives
  double build_seconds = 0;            ///< of the BVH alone
};

/// What it takes to open the backs that another camera sees (compile/open_backs.h). Without one-sided triangles all is
/// empty.
struct BackOpenings {
  std::vector<uint32_t> closed;                 ///< the surfaces of the world's triangles, none of them open
  std::vector<std::array<uint32_t, 2>> opened;  ///< by surface: the one that is absent, and the one that is lit through
  bool has_only_delta_lights = false;
  uint32_t lets_light_through = 0;  ///< of the scene with nothing open
};

struct CompiledMaterials;

/// Owns the memory of `view`. Every pointer of the view is in [arena, arena + statistics.bytes), so copying those bytes
/// and shifting the pointers makes the same scene elsewhere.
template <class Real>
struct CompiledScene {
  std::unique_ptr<std::byte, FreeArena> arena;
  SceneView<Real> view;
  SceneStatistics statistics;
  uint64_t generation = 0;  ///< counts the changes of the arena, for those who hold a copy of it
  Vec3d world_origin{};     ///< the origin of render space, in world space (compile/render_space.h)
  /// By id - 1, in the order in which they were found; empty unless they were asked for.
  std::vector<std::string> object_names, material_names;
  std::vector<std::string> light_groups;  ///< their names; likewise
  SceneOrigins origins;                   ///< if they were asked for
  // If it was compiled for several images:
  BackOpenings backs;
  std::shared_ptr<const CompiledMaterials> materials;  ///< compile/update_materials.h
};

}  // namespace alhazen::impl

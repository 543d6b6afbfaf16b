#pragma once

// What is kept of a scene that was compiled, so that some of its parts can be compiled again (compile/update_scene.h).

#include <cstdint>
#include <vector>

#include "compile/compile_scene.h"
#include "compile/instances.h"
#include "compile/light_maps.h"
#include "compile/trees.h"
#include "scene/scene.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

/// How many elements arrays had before a shape was placed. Triangles are counted in the order of placement.
struct PlacedSizes {
#define ALHAZEN_SIZE(X, kind, Record, records, Block, blocks) uint32_t records = 0;
  ALHAZEN_PRIMITIVES(ALHAZEN_SIZE, )
#undef ALHAZEN_SIZE
  uint32_t positions = 0, normals = 0, uvs = 0, vertex_attributes = 0, vertex_colours = 0, vertex_tangents = 0;
  uint32_t sphere_frames = 0, surfaces = 0;
  uint32_t lights = 0;  ///< of shapes alone

  friend bool operator==(const PlacedSizes&, const PlacedSizes&) = default;
};

template <class Real>
PlacedSizes placed_sizes(const SceneArrays<Real>& arrays, size_t described_lights);

/// What lies between two places.
PlacedSizes difference(const PlacedSizes& end, const PlacedSizes& start);

template <class Real>
struct BuiltParts {
  bool can_be_updated = false;
  CompileOptions options;
  Scene scene;  ///< as it was placed, without meshes and texels
  DescribedIndices described;
  std::vector<uint64_t> triangle_counts;  ///< by mesh
  std::vector<bool> is_object;            ///< by group
  std::vector<uint32_t> object_of;        ///< by group: index into `objects`, or none
  std::vector<PlacedSizes> placed;        ///< by placement, of the world and then of objects, and one at the end
  size_t world_placements = 0;            ///< number of those that are of the world
  WorldTree<Real> world;
  /// The binary tree by which lost light is searched where the scene does not have it.
  std::vector<Bvh2Node<Real>> search_tree;
  Diagnostics lost_light;  ///< what was found

  LightMaps<Real> maps;
  size_t texture_floats = 0;             ///< number of texel_floats that are not of maps
  std::vector<size_t> described_lights;  ///< of the first lights: index into Scene::lights
  std::vector<double> areas, measures;   ///< of the lights of shapes, see assign_light_probabilities
};

/// compile_scene for a scene of which parts will be compiled again. Lost light is not warned of, but kept.
template <class Real>
CompiledScene<Real> compile_scene(Scene&& scene, const CompileOptions& options, Diagnostics& diagnostics,
                                  BuiltParts<Real>& parts);

}  // namespace alhazen::impl

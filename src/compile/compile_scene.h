#pragma once

// Compiles the scene description: validates it, applies transforms, places instances and builds BVHs.

#include "compile/bvh/layout.h"
#include "compile/compiled_scene.h"
#include "compile/light_groups.h"
#include "scene/scene.h"

namespace alhazen::impl {

/// Overrides of the description by the command line or a caller.
struct CompileOptions {
  int64_t width = 0, height = 0;  ///< 0: as in the scene
  int threads = 0;                ///< for the BVH; 0: OpenMP's default
  BvhLayouts layouts{BvhLayout::bvh2};
  /// Instances with at most this many triangles in total are copied into the world, where traversal is faster.
  uint64_t max_copied_triangles = 1u << 17;
  uint64_t texture_budget = 0;  ///< bytes that images may take; 0: no limit
  /// Whether to move a scene that is far from the world's origin there (compile/render_space.h).
  bool in_render_space = true;
  /// Whether the camera will be changed (compile/change_camera.h). The scene does then not depend on which is first,
  /// but for where render space is.
  bool for_cameras = false;
  /// Number of segments of paths if `path` renders, to warn of light that it does not find; 0: no such check.
  uint32_t path_segments = 0;
  /// Whether surfaces get ids of objects and materials, and CompiledScene their names.
  bool names_objects = false;
  /// Whether lights get groups: these, or one for each name if there are none (compile/light_groups.h).
  bool groups_lights = false;
  std::vector<LightGroup> light_groups = {};
};

/// Consumes the description while it compiles, so that meshes are not held twice in memory. Throws InputError for
/// scenes that cannot be rendered: indices out of range, coordinates that are not finite, radii that are not positive,
/// too many primitives. Warns of what is omitted: triangles of zero area, motion of cameras and of some meshes, detail
/// of images, light that is not found.
template <class Real>
CompiledScene<Real> compile_scene(Scene&& scene, const CompileOptions& options, Diagnostics& diagnostics);

}  // namespace alhazen::impl
